import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from onebox.errors import StartError
from onebox.processes import Program, Supervisor
from tests.waiting import wait_until


def python(name: str, source: str, ready: Callable[[], bool] = lambda: True) -> Program:
    return Program(name, (sys.executable, "-c", source), ready=ready, stop_timeout_s=2.0)


def test_programs_start_in_order_and_each_waits_for_the_one_before(tmp_path: Path) -> None:
    mark = tmp_path / "first is ready"
    first = python(
        "first", f"import time; time.sleep(0.2); open({str(mark)!r}, 'w').close(); time.sleep(999)", mark.exists
    )
    second = python("second", f"import os, time; print(os.path.exists({str(mark)!r}), flush=True); time.sleep(999)")
    supervisor = Supervisor([first, second], tmp_path / "logs", say=lambda line: None)
    supervisor.start()
    wait_until(lambda: "True" in supervisor.log_path("second").read_text())
    supervisor.stop()


def test_a_program_that_ends_is_started_again(tmp_path: Path) -> None:
    starts = tmp_path / "starts"
    program = python("fragile", f"open({str(starts)!r}, 'a').write('x')")
    lines: list[str] = []
    supervisor = Supervisor([program], tmp_path / "logs", lines.append)
    supervisor.start()

    def stop_after_the_second_start() -> None:
        wait_until(lambda: starts.exists() and len(starts.read_text()) >= 2)
        supervisor.request_stop()

    watcher = threading.Thread(target=stop_after_the_second_start)
    watcher.start()
    supervisor.watch()
    watcher.join()
    supervisor.stop()
    assert lines[0] == "fragile ended (exit code 0); starting it again in 0.5 s"


def test_a_program_that_ends_before_it_is_ready_is_an_error_with_the_end_of_its_log(tmp_path: Path) -> None:
    program = python("broken", "raise SystemExit('no such database')", ready=lambda: False)
    supervisor = Supervisor([program], tmp_path / "logs", say=lambda line: None)
    with pytest.raises(StartError, match=r"broken ended at once \(exit code 1\)(.|\n)*no such database"):
        supervisor.start()


def test_a_missing_program_is_an_error(tmp_path: Path) -> None:
    supervisor = Supervisor([Program("ghost", ("/nonexistent/ghost",))], tmp_path / "logs", say=lambda line: None)
    with pytest.raises(StartError, match="ghost could not be started"):
        supervisor.start()


def test_a_program_that_ignores_sigterm_is_killed(tmp_path: Path) -> None:
    source = "import signal, time; signal.signal(15, signal.SIG_IGN); print('deaf', flush=True); time.sleep(999)"
    log = tmp_path / "logs" / "deaf.log"
    program = python("deaf", source, ready=lambda: "deaf" in log.read_text())
    lines: list[str] = []
    supervisor = Supervisor([program], tmp_path / "logs", lines.append)
    supervisor.start()
    supervisor.stop()
    assert lines == ["deaf did not stop within 2 s and is killed"]


def test_children_of_a_killed_supervisor_end_too(tmp_path: Path) -> None:
    source = (
        "import sys; from pathlib import Path; from onebox.processes import Program, Supervisor\n"
        "code = 'import os, time; print(os.getpid(), flush=True); time.sleep(999)'\n"
        "child = Program('child', (sys.executable, '-c', code))\n"
        "supervisor = Supervisor([child], Path(sys.argv[1]), print); supervisor.start(); supervisor.watch()"
    )
    parent = subprocess.Popen([sys.executable, "-c", source, str(tmp_path)])
    log = tmp_path / "child.log"
    wait_until(lambda: log.exists() and log.read_text().endswith("\n"))
    os.kill(parent.pid, signal.SIGKILL)
    parent.wait()
    pid = int(log.read_text())

    def is_gone() -> bool:
        try:
            return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z"
        except FileNotFoundError:
            return True

    wait_until(is_gone)
