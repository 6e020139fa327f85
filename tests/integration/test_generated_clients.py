"""Clients that others' generators make of `openapi.yaml`: their types are sound, and they repair a scan."""

import json
import shutil
import sys
from pathlib import Path

import pytest

from quadpatch.formats.reading import read_scan
from quadpatch.mesh.boundary import boundary_loops
from tests.contract.tools import DOCUMENT, NODE, run, run_node
from tests.integration.conftest import RunningStack, ply_bytes, punched_relief

CONTRACT = NODE.parent
DONE = {"state": "succeeded", "holes": ["skipped", *["filled_smooth"] * 2], "code": "mesh_not_found"}


@pytest.fixture
def scan(tmp_path: Path) -> Path:
    path = tmp_path / "scan.ply"
    path.write_bytes(ply_bytes(*punched_relief(30, n_holes=2)))
    return path


def test_the_python_client_is_typed_and_repairs_a_scan(local_stack: RunningStack, scan: Path, tmp_path: Path) -> None:
    options = ["--path", str(DOCUMENT), "--config", str(CONTRACT / "generator.yaml"), "--output-path", "generated"]
    made = run(["openapi-python-client", "generate", *options], tmp_path)
    assert made.returncode == 0, made.stdout + made.stderr
    assert "WARNING" not in made.stdout + made.stderr
    shutil.copy(CONTRACT / "repair.py", tmp_path / "generated")
    checked = run([sys.executable, "-m", "mypy", "--strict", "quadpatch_api", "repair.py"], tmp_path / "generated")
    assert checked.returncode == 0, checked.stdout
    repaired = tmp_path / "repaired.ply"
    done = run([sys.executable, "repair.py", local_stack.url, str(scan), str(repaired)], tmp_path / "generated")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == DONE
    assert is_repaired(scan, repaired)


def test_the_typescript_client_is_typed_and_repairs_a_scan(
    local_stack: RunningStack, scan: Path, tmp_path: Path
) -> None:
    # Else fields with a default would have to be sent.
    made = run_node(
        ["openapi-typescript", str(DOCUMENT), "--default-non-nullable", "false", "-o", "schema.d.ts"], tmp_path
    )
    assert made.returncode == 0, made.stderr
    for name in ("repair.ts", "tsconfig.json", "package.json"):
        shutil.copy(NODE / name, tmp_path)
    (tmp_path / "node_modules").symlink_to(NODE / "node_modules")
    checked = run_node(["tsc", "--project", str(tmp_path)], tmp_path)
    assert checked.returncode == 0, checked.stdout
    repaired = tmp_path / "repaired.ply"
    done = run_node(["node", "repair.ts", local_stack.url, str(scan), str(repaired)], tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == DONE
    assert is_repaired(scan, repaired)


def is_repaired(before: Path, after: Path) -> bool:
    """Whether two holes are gone and the measured vertices are as they were."""
    old, new = read_scan(before), read_scan(after)
    n_loops = [len(boundary_loops(scan.triangles).loops) for scan in (old, new)]
    is_kept = new.vertices[: len(old.vertices)].tobytes() == old.vertices.tobytes()
    return is_kept and n_loops[0] - n_loops[1] == 2
