"""An engine that misbehaves as the options of its request say."""

import ctypes
import json
import os
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from quadpatch.errors import ReadError
from quadpatch.processes import ProcessPool
from worker.engine.entry import run_confined
from worker.engine.reports import Reporter
from worker.engine.request import EngineRequest

if TYPE_CHECKING:
    from tests.worker.reaching_out import ATTEMPTS
else:
    # The fork server finds this folder by PYTHONPATH, and does not find `tests`.
    from reaching_out import ATTEMPTS


def run_request(folder: Path, descriptor: int) -> None:
    def run_behaviour(request: EngineRequest, reporter: Reporter, pool: ProcessPool) -> None:
        reporter.progress("fill", 0.5)
        if request.options.get("delivers"):
            (folder / "repaired.ply").write_text("a mesh")
            reporter.delivered()
            reporter.progress("preview", 0.0)
        behave = getattr(Behaviours, request.options["behaviour"])
        if request.options.get("in_helper"):
            pool.submit(in_helper, behave, folder).result()
        else:
            behave(folder)
        (folder / "facts.json").write_text(
            json.dumps({"cwd": os.getcwd(), "pid": os.getpid(), "names": list(os.environ)})
        )

    if EngineRequest.load(folder).options["behaviour"] == "start_a_grandchild":
        grandchild = subprocess.Popen(["sleep", "600"])
        (folder / "grandchild").write_text(str(grandchild.pid))
    run_confined(folder, descriptor, run_behaviour)


def in_helper(behave: Callable[[Path], None], folder: Path) -> None:
    (folder / "helper").write_text(str(os.getpid()))
    behave(folder)


class Behaviours:
    @staticmethod
    def behave(folder: Path) -> None:
        libc = ctypes.CDLL(None)
        libc.puts(b"this goes to the log")
        libc.fflush(None)

    @staticmethod
    def hang_in_native_code(folder: Path) -> None:
        # PyDLL keeps the interpreter lock, so no Python signal handler could ever run.
        ctypes.PyDLL(None).sleep(600)

    @staticmethod
    def hog_memory(folder: Path) -> None:
        blocks = []
        while True:
            blocks.append(bytearray(16 << 20))
            time.sleep(0.01)

    @staticmethod
    def take_memory_for_a_moment(folder: Path) -> None:
        bytearray(200 << 20)

    @staticmethod
    def take_memory_for_a_while(folder: Path) -> None:
        held = b"x" * (200 << 20)
        time.sleep(1.0)
        del held

    @staticmethod
    def ask_for_too_much_at_once(folder: Path) -> None:
        bytearray(1 << 40)

    @staticmethod
    def crash(folder: Path) -> None:
        ctypes.string_at(0)

    @staticmethod
    def leave_silently(folder: Path) -> None:
        os._exit(3)

    @staticmethod
    def fill_the_disk(folder: Path) -> None:
        with (folder / "huge").open("wb") as file:
            while True:
                file.write(bytes(1 << 20))

    @staticmethod
    def meet_a_full_disk(folder: Path) -> None:
        os.dup2(os.open("/dev/full", os.O_WRONLY), 2)
        Path("/dev/full").write_text("no room")

    @staticmethod
    def start_a_grandchild(folder: Path) -> None:
        """Done before the engine is shut in, as on a kernel that can't do that."""

    @staticmethod
    def reach_out(folder: Path) -> None:
        reached = {name: attempt(folder) for name, attempt in ATTEMPTS.items()}
        (folder / "reached.json").write_text(json.dumps(reached))

    @staticmethod
    def ignore_signals_and_hang(folder: Path) -> None:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        time.sleep(600)

    @staticmethod
    def raise_an_error_with_a_path(folder: Path) -> None:
        raise ReadError(f"cannot read {folder / 'source.ply'}")

    @staticmethod
    def raise_something_unforeseen(folder: Path) -> None:
        raise KeyError("secret detail")
