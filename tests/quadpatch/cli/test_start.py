"""What the command line loads: nothing before it is needed. Tests `quadpatch.cli.scipy_start` and `quadpatch.progress`.

Seconds differ between machines and say nothing on a busy one; which modules are loaded does not.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.quadpatch.shapes import bumpy_plate, punched, write_ply
from tests.waiting import GUARD_S

# Runs a command in this process and prints on standard error which modules it has loaded by its end.
RUN = """
import atexit, sys
atexit.register(lambda: print("loaded", *sorted(sys.modules), file=sys.stderr))
from quadpatch.cli.app import app
app(prog_name="quadpatch")
"""
# Libraries of the method, and what some commands or options need of the rest.
NUMERICAL = {"numpy", "scipy", "igl", "embreex", "manifold3d", "onnxruntime", "safetensors", "pymeshlab", "trimesh"}
PICTURES = {"PIL", "matplotlib", "jinja2"}
# A repair by geometry alone of a PLY needs numpy, scipy and igl.
NOT_FOR_GEOMETRY = {
    *PICTURES,
    *("constriction", "embreex", "manifold3d", "networkx", "onnxruntime", "pandas", "pymeshlab", "safetensors"),
    *("pydantic", "torch", "trimesh", "xml.parsers.expat", "rich.progress", "scipy.optimize"),
    *(
        "numpy.f2py.crackfortran",
        "numpy.testing._private",
        "scipy.special",
        "quadpatch.preview",
        "quadpatch.formats.gltf",
    ),
}


def loaded_by(*arguments: str | Path, code: int = 0) -> set[str]:
    command = [sys.executable, "-c", RUN, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=GUARD_S, check=False)
    assert done.returncode == code, done.stderr
    return set(done.stderr.rpartition("loaded ")[2].split())


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["--help"], 0),
        (["fill", "--help"], 0),
        (["denoise", "--help"], 0),
        (["fill", "--no-such-option"], 2),
        (["fill", "in.ply", "-o", "no_such_folder/out.ply"], 1),
        (["fill", "in.ply", "-o", "out.ply", "--overlap", "99"], 1),
        (["restore", "in.ply", "-o", "in.ply", "--missing", "nan"], 1),
    ],
)
def test_help_and_wrong_usage_load_no_numerical_library(arguments: list[str], code: int) -> None:
    assert loaded_by(*arguments, code=code) & (NUMERICAL | PICTURES) == set()


def test_a_repair_by_geometry_loads_what_it_uses(tmp_path: Path) -> None:
    scan = write_ply(tmp_path / "in.ply", punched(bumpy_plate(40, 2.0), (0.1, 0.1, 0), radius=0.2), "f4")
    loaded = loaded_by("fill", scan, "-o", tmp_path / "out.ply", "--model", "smooth")
    assert loaded & NOT_FOR_GEOMETRY == set()
    assert {"numpy", "scipy.spatial", "igl"} <= loaded


def test_what_was_put_off_is_there_when_it_is_asked_for() -> None:
    """Before scipy, and after it."""
    program = (
        "import sys; from quadpatch.cli.scipy_start import prepare_libraries as prepare; prepare(); prepare()\n"
        "import scipy.spatial, numpy; assert 'numpy.testing._private' not in sys.modules\n"
        "from numpy.testing import assert_allclose; assert_allclose(1.0, 1.0); assert numpy.f2py.get_include()\n"
        "prepare(); assert 'numpy.testing._private' in sys.modules\n"
        "assert 'scipy.special' not in sys.modules\n"
        "from numpy import eye; from scipy.spatial import geometric_slerp as slerp, transform\n"
        "assert scipy.spatial.distance.pdist(eye(2))[0] ** 2 > 1.9; assert slerp(*eye(2), [0.5])[0, 0] > 0.7\n"
        "assert transform.Rotation.identity().magnitude() == 0; assert 'scipy.special' in sys.modules"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, timeout=GUARD_S, check=False)
    assert done.returncode == 0, done.stderr


def test_the_blas_gets_one_thread_unless_it_is_told_otherwise() -> None:
    program = (
        "import os; from quadpatch.cli.scipy_start import prepare_libraries; prepare_libraries()\n"
        "from threadpoolctl import threadpool_info\n"
        "print(*{pool['num_threads'] for pool in threadpool_info() if pool['internal_api'] == 'openblas'})"
    )
    for told, expected in ((None, "1"), ("2", "2")):
        environment = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
        environment |= {} if told is None else {"OPENBLAS_NUM_THREADS": told}
        done = subprocess.run(
            [sys.executable, "-c", program],
            env=environment,
            capture_output=True,
            text=True,
            timeout=GUARD_S,
            check=True,
        )
        assert done.stdout.split() == [expected]
