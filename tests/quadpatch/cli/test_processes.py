"""A repair on the command line that several processes share."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from quadpatch.processes import LEAST_BYTES
from tests.quadpatch.shapes import bumpy_plate, on_surface, punched, write_ply
from tests.waiting import wait_until


@pytest.fixture
def scan(tmp_path: Path) -> Path:
    """A scan large enough for two processes."""
    plate = bumpy_plate(160, 4.0)
    path = write_ply(tmp_path / "scan.ply", punched(plate, *on_surface(plate, (0.0, 0.0)), radius=0.18), "f8")
    assert path.stat().st_size > LEAST_BYTES
    return path


def started(scan: Path, n_threads: int) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "quadpatch", "fill", str(scan), "-o", str(scan.with_name("filled.ply"))]
    environment = {**os.environ, "OMP_NUM_THREADS": str(n_threads)}
    return subprocess.Popen(
        [*command, "--model", "smooth", "--quiet"], env=environment, stderr=subprocess.PIPE, text=True
    )


def helpers_of(repair: subprocess.Popen[str]) -> list[psutil.Process]:
    return psutil.Process(repair.pid).children()


def test_a_helper_that_is_killed_ends_the_repair_with_a_code(scan: Path) -> None:
    repair = started(scan, 2)
    wait_until(lambda: len(helpers_of(repair)) == 1)
    (helper,) = helpers_of(repair)
    helper.kill()
    _, errors = repair.communicate()
    assert repair.returncode == 1
    assert errors == "process_lost: a process that shared the work ended by SIGKILL\n"
    assert not scan.with_name("filled.ply").exists()


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_no_helper_outlives_a_repair_that_is_ended(scan: Path, number: signal.Signals) -> None:
    repair = started(scan, 2)
    wait_until(lambda: len(helpers_of(repair)) == 1)
    (helper,) = helpers_of(repair)
    repair.send_signal(number)
    repair.communicate()
    wait_until(lambda: not helper.is_running() or helper.status() == psutil.STATUS_ZOMBIE)


def test_one_thread_means_one_process(scan: Path) -> None:
    program = (
        "import os, sys\n"
        "os.fork = lambda: sys.exit('forked')\n"
        "from quadpatch.cli.app import app\n"
        f"app(['fill', {str(scan)!r}, '-o', {str(scan.with_name('filled.ply'))!r}, '--model', 'smooth', '--quiet'])\n"
    )
    for n_threads, status in ((1, 0), (2, 1)):
        environment = {**os.environ, "OMP_NUM_THREADS": str(n_threads)}
        done = subprocess.run(
            [sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == status
        assert ("forked" in done.stderr) == (n_threads > 1)
