"""The first thing that a newcomer runs."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from onebox.demo import find_scan
from quadpatch.formats.reading import read_scan
from tests.waiting import GUARD_S


@pytest.mark.slow
def test_the_demo_repairs_a_real_scan_and_leaves_four_files(tmp_path: Path) -> None:
    folder = tmp_path / "demo"
    command = [sys.executable, "-m", "onebox", "demo", "--folder", str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=2 * GUARD_S)
    assert done.returncode == 0, done.stdout + done.stderr
    names = ["before_after.png", "face000_repaired.ply", "report.html", "report.json"]
    assert sorted(path.name for path in folder.iterdir()) == names
    assert all(f"wrote {folder / name}" in done.stdout for name in names)
    report = json.loads((folder / "report.json").read_text())
    assert f"face000.ply has {report['counts']['found']} holes" in done.stdout
    assert all(f"{stage['name']} " in done.stdout for stage in report["stages"])
    assert report["provenance"]["output"]["sha256"] in (folder / "report.html").read_text("utf-8")
    assert (folder / "before_after.png").read_bytes().startswith(b"\x89PNG")
    before, after = read_scan(find_scan()), read_scan(folder / "face000_repaired.ply")
    assert np.array_equal(after.vertices[: len(before.vertices)], before.vertices)
    assert np.array_equal(after.triangles[: len(before.triangles)], before.triangles)
