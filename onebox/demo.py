"""`python -m onebox demo`: repair a real scan over HTTP, and leave the result to look at.

Tested in `tests/integration/test_demo.py`.
"""

import importlib.util
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console

from onebox.errors import DemoError
from onebox.local_stack import ADDRESS_FILE, LOCK_NAME
from onebox.logs import log_tail
from onebox.processes import stop
from quadpatch_client.errors import ClientError
from quadpatch_client.options import HoleChoice, MethodChoice
from quadpatch_client.repairing import Task, repair
from quadpatch_client.screen import Screen
from quadpatch_client.sdk import Client
from quadpatch_rules.parent_death import parent_death_signal

_HOST = "127.0.0.1"
_SCAN = Path("tests/sample_meshes/rangemaps/face000.ply")
_READY_TIMEOUT_S = 900.0
_STOP_TIMEOUT_S = 40.0
_TIMEOUT_S = 600.0


def demo(folder: Path) -> None:
    """Start a local stack, repair the face scan that comes with pymeshlab, and leave three files in `folder`.

    Raises
    ------
    DemoError
        If any of it did not work.
    """
    scan = find_scan()
    folder.mkdir(parents=True, exist_ok=True)
    screen = Screen(console=Console(highlight=False))
    task = Task(
        source=scan,
        output=folder / "face000_repaired.ply",
        holes=HoleChoice(),
        method=MethodChoice(),
        rest={"output": {"preview": True, "html_report": True}, "label": "demo"},
        report=folder / "report.json",
        preview=folder / "before_after.png",
        html=folder / "report.html",
        timeout_s=_TIMEOUT_S,
    )
    for path in (task.output, task.report, task.preview, task.html):
        if path is not None:
            path.unlink(missing_ok=True)  # what is there afterwards is of this run
    data = folder / "box"
    _clear(data)
    screen.say("starting Valkey, dispatcher, API and workers ...")
    with running_stack(data) as url, Client(url) as client:
        screen.say(f"the service is ready on {url}")
        try:
            repair(client, screen, task)
        except ClientError as error:
            raise DemoError(f"{error}; the logs are in {data / 'logs'}") from error
    _clear(data)


def find_scan() -> Path:
    """Return the path of the face scan inside the installed pymeshlab.

    Raises
    ------
    DemoError
        If it is not there.
    """
    # The package is only looked up, not loaded: its libraries are of no use here.
    spec = importlib.util.find_spec("pymeshlab")
    for root in (spec.submodule_search_locations or []) if spec else []:
        if (Path(root) / _SCAN).is_file():
            return Path(root) / _SCAN
    raise DemoError(f"the installed pymeshlab has no {_SCAN}")


@contextmanager
def running_stack(data: Path) -> Iterator[str]:
    """Run a local stack in a process of its own for the length of a `with` block, and yield its address.

    Raises
    ------
    DemoError
        If it does not come up; the message carries the end of its log.
    """
    address_file = data / ADDRESS_FILE
    address_file.unlink(missing_ok=True)
    data.mkdir(parents=True, exist_ok=True)
    log_path = data / "box.log"
    with log_path.open("wb") as log:
        process = subprocess.Popen(
            [sys.executable, "-m", "onebox", "serve", "--port", "0", "--data", str(data)],
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=log,
            env={**os.environ, "QUADPATCH_HOST": _HOST},
            preexec_fn=parent_death_signal(os.getpid()),  # noqa: PLW1509 - two system calls, no lock taken
            start_new_session=True,
        )
    try:
        yield _wait_for_address(address_file, process, log_path)
    finally:
        stop(process, _STOP_TIMEOUT_S)


def _wait_for_address(address_file: Path, process: subprocess.Popen[bytes], log_path: Path) -> str:
    deadline = time.monotonic() + _READY_TIMEOUT_S
    while not address_file.exists() or not (address := address_file.read_text(encoding="ascii")):
        if process.poll() is not None:
            raise DemoError(f"the local stack ended before it was ready; {log_tail(log_path)}")
        if time.monotonic() > deadline:
            raise DemoError(f"the local stack was not ready within {_READY_TIMEOUT_S:.0f} s; {log_tail(log_path)}")
        time.sleep(0.1)
    return address


def _clear(data: Path) -> None:
    """Remove the data of an earlier demo, and nothing else."""
    if (data / LOCK_NAME).exists():
        shutil.rmtree(data)
