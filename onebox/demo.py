"""`python -m onebox demo`: repair a real scan and a relief over HTTP, and leave the results to look at.

Tested in `tests/integration/test_demo.py`.
"""

import importlib.util
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
import webbrowser
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console

from onebox.errors import DemoError
from onebox.local_stack import ADDRESS_FILE, LOCK_NAME
from onebox.logs import log_tail
from onebox.processes import stop
from onebox.serve import STOP_SIGNALS
from quadpatch_client.errors import ClientError
from quadpatch_client.options import MethodChoice
from quadpatch_client.repairing import Task, repair
from quadpatch_client.screen import Screen
from quadpatch_client.sdk import Client
from quadpatch_rules.parent_death import parent_death_signal

if TYPE_CHECKING:
    from quadpatch_client.schema import Job

_HOST = "127.0.0.1"
_SCAN = Path("tests/sample_meshes/rangemaps/face000.ply")
_READY_TIMEOUT_S = 900.0
_STOP_TIMEOUT_S = 40.0
_TIMEOUT_S = 600.0
# What fills the relief, where that goes, and how.
_FILLS = (
    ("geometry alone", "relief_smooth.ply", MethodChoice(method="smooth")),
    ("learned from the mesh", "relief_learned.ply", MethodChoice(method="dictionary", model="self")),
)
# The files that a demo leaves.
RESULTS = (
    *("before_after.png", "face000_repaired.ply", "report.html", "report.json"),
    *("relief.png", "relief.ply", "relief_learned.ply", "relief_smooth.ply"),
)


def demo(folder: Path, *, stays: bool = False) -> None:
    """Start a local stack, show on two scans what it does, and leave the results in `folder`.

    The face scan that comes with pymeshlab is repaired as it would be at a station. A relief with holes whose surface
    is known is filled by geometry alone and by what is learned from the relief: a picture shows both, and their errors.

    Parameters
    ----------
    folder : Path
    stays : bool
        Whether to open the page in the browser at the end, and to serve it until Ctrl-C.

    Raises
    ------
    DemoError
        If any of it did not work.
    """
    scan = find_scan()
    folder.mkdir(parents=True, exist_ok=True)
    for name in RESULTS:
        (folder / name).unlink(missing_ok=True)  # what is there afterwards is of this run
    screen = Screen(console=Console(highlight=False))
    data = folder / "box"
    _clear(data)
    screen.say("starting Valkey, dispatcher, API and workers ...")
    with running_stack(data) as url, Client(url) as client:
        screen.say(f"the service is ready on {url}")
        try:
            job = _repair_scan(client, screen, scan, folder)
            _repair_relief(client, screen, folder)
        except ClientError as error:
            raise DemoError(f"{error}; the logs are in {data / 'logs'}") from error
        if stays:
            _stay(screen, f"{url}/#/jobs/{job.id}")
    _clear(data)


def _repair_scan(client: Client, screen: Screen, scan: Path, folder: Path) -> "Job":
    """Repair a raw scan with default options."""
    task = Task(
        source=scan,
        output=folder / "face000_repaired.ply",
        rest={"output": {"preview": True, "html_report": True}, "label": "demo"},
        report=folder / "report.json",
        preview=folder / "before_after.png",
        html=folder / "report.html",
        timeout_s=_TIMEOUT_S,
    )
    return repair(client, screen, task)


def _repair_relief(client: Client, screen: Screen, folder: Path) -> None:
    """Fill a relief by geometry and by a learned model, and compare both with the surface that was cut away."""
    # These load the numerical libraries, while the lines above appear at once.
    from onebox.relief import PunchedRelief  # noqa: PLC0415
    from quadpatch.formats.plain import write_mesh  # noqa: PLC0415
    from quadpatch.formats.reading import read_scan  # noqa: PLC0415
    from quadpatch.types import TriangleMesh  # noqa: PLC0415

    relief, source = PunchedRelief.make(), folder / "relief.ply"
    write_mesh(source, relief.damaged, unit=None)
    screen.say("a relief with nine holes, cut where its surface is known:")
    repairs = {}
    for name, output, method in _FILLS:
        task = Task(source=source, output=folder / output, method=method, rest={"label": name}, timeout_s=_TIMEOUT_S)
        repair(client, screen, task)
        scan = read_scan(task.output)
        repairs[name] = TriangleMesh(scan.vertices, scan.triangles)
    for name, repaired in repairs.items():
        screen.say(f"{name}: off by {relief.error(repaired):.1%} of the holes' radius on average")
    relief.draw(repairs, folder / "relief.png")
    screen.say(f"wrote {folder / 'relief.png'}", style="green")


def _stay(screen: Screen, page: str) -> None:
    """Open a page in the browser, where there is one, and wait for Ctrl-C or SIGTERM."""
    ended = threading.Event()
    for number in STOP_SIGNALS:
        signal.signal(number, lambda *_: ended.set())
    screen.say(f"the page of the first job: {page}\nCtrl-C ends the service; the files stay")
    webbrowser.open(page)
    ended.wait()


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
