"""The report as a PDF: its page, printed by a browser that the operator installs.

The browser runs in a folder of its own, confined (`worker.engine.renderer`). A job does without a PDF: what goes wrong
here is a warning in the report.
"""

import contextlib
import logging
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import psutil

from quadpatch.formats.output_files import write_whole
from quadpatch_rules.coded_warnings import warning
from worker.engine.confinement import weaknesses
from worker.engine.limits import EngineLimits
from worker.engine.renderer import MOST_PDF_MB
from worker.engine.request import PAGE_NAME, PDF_NAME
from worker.failures import EngineStoppedError, StopReason
from worker.results import add_warning

MOST_SECONDS = 60.0
_TICK_S = 0.1
_FLAGS = (
    "--headless=new",
    # Its own sandbox needs rights that a container has not: it is confined already, as one process, for others would
    # have to read of each other in /proc.
    "--no-sandbox",
    "--single-process",
    "--no-zygote",
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--disable-background-networking",
    "--disable-breakpad",
    "--disable-crash-reporter",
    "--disable-extensions",
    "--disable-sync",
    "--no-first-run",
    "--no-pdf-header-footer",
)

_log = logging.getLogger("quadpatch.worker.pdf")


def add_pdf(
    folder: Path, renderer: str, limits: EngineLimits, stop_reason: Callable[[], StopReason | None] = lambda: None
) -> None:
    """Print the page of a job, where there is one, to a PDF beside it.

    Parameters
    ----------
    folder : Path
        Of the request.
    renderer : str
        Path of the browser; empty: no PDF.
    limits : EngineLimits
        Of the engine; of its time the renderer has at most a minute.
    stop_reason : callable
        Asked ten times a second whether to end, and why.

    Raises
    ------
    EngineStoppedError
        If it was to end.
    """
    if not renderer or not (folder / PAGE_NAME).is_file():
        return
    problem = _print(folder, renderer, limits, stop_reason)
    if problem is not None:
        _log.warning("there is no PDF: %s", problem)
        add_warning(folder, warning("no_pdf_report", reason=problem))


def _print(
    folder: Path, renderer: str, limits: EngineLimits, stop_reason: Callable[[], StopReason | None]
) -> str | None:
    """Return why there is no PDF, None where there is one."""
    if weaknesses():
        return "this kernel can't confine the renderer"
    with tempfile.TemporaryDirectory(prefix="pdf-", dir=folder, ignore_cleanup_errors=True) as place:
        try:
            shutil.copyfile(folder / PAGE_NAME, Path(place, PAGE_NAME))
            problem = _run(Path(place), renderer, limits, stop_reason)
            if problem is not None:
                return problem
            printed = _read(Path(place, PDF_NAME))
            write_whole(folder / PDF_NAME, printed)
        except OSError as error:
            return f"the renderer left no PDF ({error.strerror})"
    return None


def _run(place: Path, renderer: str, limits: EngineLimits, stop_reason: Callable[[], StopReason | None]) -> str | None:
    most_s = min(MOST_SECONDS, limits.time_s)
    arguments = [*_FLAGS, f"--user-data-dir={place / 'profile'}", f"--print-to-pdf={place / PDF_NAME}"]
    process = subprocess.Popen(
        [sys.executable, "-m", "worker.engine.renderer", place, renderer, *arguments, (place / PAGE_NAME).as_uri()],
        # No password of the worker: of its variables only where programs and packages lie.
        env={"HOME": str(place), "TMPDIR": ".", "LANG": "C.UTF-8", **_paths()},
        # Its sockets lie there; absolute, their paths might be longer than the 108 characters that they may have.
        cwd=place,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    deadline = time.monotonic() + most_s
    try:
        while process.poll() is None:
            reason = stop_reason()
            if reason is not None:
                raise EngineStoppedError(reason)
            if time.monotonic() > deadline:
                return f"the renderer took longer than {most_s:g} s"
            if _memory_mb(process.pid) > limits.memory_mb:
                return f"the renderer needs more than {limits.memory_mb} MiB"
            time.sleep(_TICK_S)
    finally:
        _end(process)
    return None if process.returncode == 0 else f"the renderer ended with status {process.returncode}"


def _paths() -> dict[str, str]:
    return {name: os.environ[name] for name in ("PATH", "PYTHONPATH", "LD_LIBRARY_PATH") if name in os.environ}


def _processes(pid: int) -> list[psutil.Process]:
    try:
        process = psutil.Process(pid)
        return [process, *process.children(recursive=True)]
    except psutil.Error:
        return []


def _memory_mb(pid: int) -> float:
    """Memory that the processes of the renderer share with no other, in MiB."""
    total = 0
    for process in _processes(pid):
        with contextlib.suppress(psutil.Error):
            total += process.memory_full_info().uss
    return total / 2**20


def _end(process: "subprocess.Popen[bytes]") -> None:
    """End the renderer and all that it started."""
    for child in _processes(process.pid)[1:]:
        with contextlib.suppress(psutil.Error):
            child.kill()
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def _read(path: Path) -> bytes:
    """Read what the renderer wrote; a link, which could lead anywhere, is refused."""
    with open(os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK), "rb") as file:
        printed = file.read((MOST_PDF_MB << 20) + 1)
    if not printed.startswith(b"%PDF-") or len(printed) > MOST_PDF_MB << 20:
        raise OSError(0, "it is none, or too large")
    return printed
