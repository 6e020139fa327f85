"""The first thing that a newcomer runs."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import httpx
import numpy as np
import pytest

from onebox.demo import RESULTS, find_scan
from quadpatch.formats.reading import read_scan
from tests.waiting import GUARD_S, wait_until


def run_demo(folder: Path) -> tuple[httpx.Response, str]:
    """Run it until its page has been looked at: what it answered, and what the demo wrote to the terminal."""
    command = [sys.executable, "-m", "onebox", "demo", "--stay", "--folder", str(folder)]
    opened, log = folder.with_name("opened"), folder.with_name("log")
    write = "import pathlib, sys; pathlib.Path(sys.argv[2]).write_text(sys.argv[1])"
    environment = {**os.environ, "BROWSER": f"{sys.executable} -c '{write}' %s {opened}"}
    with log.open("wb") as out, subprocess.Popen(command, stdout=out, stderr=out, env=environment) as demo:
        try:
            url = wait_until(lambda: opened.read_text() if opened.exists() else None, demo, log)
            page = httpx.get(url, timeout=GUARD_S)
            # What a shell starts in the background ignores SIGINT.
            demo.terminate()
            assert demo.wait(GUARD_S) == 0, log.read_text()
        finally:
            demo.kill()
    return page, log.read_text()


@pytest.mark.slow
def test_the_demo_repairs_a_real_scan_and_a_relief_and_leaves_what_they_became(tmp_path: Path) -> None:
    folder = tmp_path / "demo"
    page, output = run_demo(folder)
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
