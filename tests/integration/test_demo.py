"""The first thing that a newcomer runs."""

import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import httpx
import numpy as np
import pytest

from onebox.demo import RESULTS, find_scan
from quadpatch.formats.reading import read_scan
from tests.waiting import GUARD_S, wait_until


@pytest.mark.slow
def test_the_demo_repairs_a_real_scan_and_a_relief_and_leaves_what_they_became(tmp_path: Path) -> None:
    folder = tmp_path / "demo"
    command = [sys.executable, "-m", "onebox", "demo", "--stay", "--folder", str(folder)]
    opened = tmp_path / "opened"
    write = "import pathlib, sys; pathlib.Path(sys.argv[2]).write_text(sys.argv[1])"
    environment = {**os.environ, "BROWSER": f"{sys.executable} -c '{write}' %s {opened}"}
    log = tmp_path / "log"
    with log.open("wb") as out, subprocess.Popen(command, stdout=out, stderr=out, env=environment) as demo:
        url = wait_until(lambda: opened.read_text() if opened.exists() else None, demo, log)
        page = httpx.get(url, timeout=GUARD_S)
        demo.send_signal(signal.SIGINT)
        demo.wait(GUARD_S)
    output = log.read_text()
    assert demo.returncode == 0, output
    assert page.status_code == 200
    assert "text/html" in page.headers["content-type"]
    assert sorted(path.name for path in folder.iterdir()) == sorted(RESULTS)
    assert all(f"wrote {folder / name}" in output for name in RESULTS if name != "relief.ply")
    report = json.loads((folder / "report.json").read_text())
    assert f"face000.ply has {report['counts']['found']} holes" in output
    assert all(f"{stage['name']} " in output for stage in report["stages"])
    assert report["provenance"]["output"]["sha256"] in (folder / "report.html").read_text("utf-8")
    errors = [float(text) for text in re.findall(r"off by ([0-9.]+)% of the holes' radius", output)]
    # What is learned from the relief continues it far better.
    assert len(errors) == 2
    assert errors[1] < 0.6 * errors[0]
    assert (folder / "relief.png").read_bytes().startswith(b"\x89PNG")
    assert (folder / "before_after.png").read_bytes().startswith(b"\x89PNG")
    before, after = read_scan(find_scan()), read_scan(folder / "face000_repaired.ply")
    assert np.array_equal(after.vertices[: len(before.vertices)], before.vertices)
    assert np.array_equal(after.triangles[: len(before.triangles)], before.triangles)
