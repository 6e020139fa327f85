"""Tests `worker.engine.preloading`."""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.quadpatch.shapes import bumpy_plate, punched, write_ply
from tests.waiting import GUARD_S

# Repairs a mesh as an engine does, and prints which modules that loaded on top of what the fork server has.
LOADED_BY_A_REPAIR = """
import sys
from pathlib import Path
import worker.engine.main
from quadpatch.repair import repair_file

before = set(sys.modules)
source, folder, model, *suffixes = sys.argv[1:]
read = Path(source)
for suffix in suffixes:
    output = Path(folder) / f"out.{suffix}"
    repair_file(read, output, model)
    read = output
print(*sorted(name for name in set(sys.modules) - before if not name.startswith("encodings.")))
"""


@pytest.mark.parametrize(
    ("model", "suffixes"),
    [
        ("smooth", ("glb", "3mf", "obj", "stl", "off", "gltf", "ply")),
        ("self", ("ply",)),
        ("general-dictionary@1", ("ply",)),
        ("general-residual@1", ("ply",)),
        ("auto", ("ply",)),
    ],
)
def test_an_engine_loads_nothing_that_the_fork_server_has_not(
    tmp_path: Path, model: str, suffixes: tuple[str, ...]
) -> None:
    scan = write_ply(tmp_path / "in.ply", punched(bumpy_plate(40, 2.0), (0.1, 0.1, 0), radius=0.2))
    command = [sys.executable, "-c", LOADED_BY_A_REPAIR, str(scan), str(tmp_path), model, *suffixes]
    done = subprocess.run(command, capture_output=True, text=True, timeout=GUARD_S, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == []
