"""The service in a process that is killed and started again, on the same port and with the same data."""

import os
import subprocess
import sys
import threading
from collections.abc import Mapping
from pathlib import Path

import psutil

from tests.servers import free_port
from tests.waiting import end, wait_until_answered


class KillableService:
    """`python -m service` under a supervisor.

    Parameters
    ----------
    folder : Path
        Of data and log.
    variables : mapping
        Environment of the service besides that of this process.
    """

    def __init__(self, folder: Path, variables: Mapping[str, str]) -> None:
        self.port = free_port()
        self.url = f"http://127.0.0.1:{self.port}"
        self.n_kills = 0
        self._log = folder / "service.log"
        own = {"QUADPATCH_DATA_DIR": str(folder / "data"), "QUADPATCH_PORT": str(self.port)}
        inherited = {name: value for name, value in os.environ.items() if not name.startswith("QUADPATCH_")}
        self._environment = {**inherited, **own, **variables}
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Start it where it does not run, and wait until it answers."""
        with self._lock:
            self._start()

    def kill(self) -> None:
        """End it as the kernel does that runs out of memory; it is started again meanwhile."""
        with self._lock:
            process = self._start()
            process.kill()
            process.wait()
            self.n_kills += 1
        threading.Thread(target=self.start, daemon=True).start()

    def stop(self) -> None:
        """Ask it to end."""
        with self._lock:
            if self._process is not None:
                end(self._process)

    def _start(self) -> "subprocess.Popen[bytes]":
        if self._process is None or self._process.poll() is not None:
            with self._log.open("ab") as log:
                command = [sys.executable, "-m", "service"]
                self._process = subprocess.Popen(command, env=self._environment, stdout=log, stderr=log)
            wait_until_answered(f"{self.url}/healthz", self._process, self._log)
        return self._process

    @property
    def memory_bytes(self) -> int:
        """What it has in memory now."""
        return 0 if self._process is None else psutil.Process(self._process.pid).memory_info().rss
