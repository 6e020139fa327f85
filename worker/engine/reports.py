"""What an engine child tells its worker, as JSON lines through one pipe.

`{"processes"}`, the ids of those that share the work, before it begins; `{"stage", "fraction"}` while it works,
`{"delivered": true}` once all that a result needs lies in the folder and only optional steps are left, and at last
`{"ok": true}` or `{"ok": false, "failure": {...}}`.
"""

import json
import os
import time
from dataclasses import asdict
from typing import Any

from worker.failures import Failure

# More reports than this only cost time on both sides.
_REPORT_INTERVAL_S = 0.05


class Reporter:
    """Writes JSON lines into the pipe and remembers the stage."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._last = 0.0
        self.stage: str | None = None

    def processes(self, process_ids: list[int]) -> None:
        """Report which processes share the work."""
        self._send({"processes": process_ids})

    def progress(self, stage: str, fraction: float) -> None:
        """Report progress, thinned out; a new stage is always reported."""
        now = time.monotonic()
        if stage == self.stage and now - self._last < _REPORT_INTERVAL_S:
            return
        self.stage, self._last = stage, now
        self._send({"stage": stage, "fraction": round(float(fraction), 4)})

    def delivered(self) -> None:
        """Report that the result is complete in the folder: it is kept even if the engine fails from here on."""
        self._send({"delivered": True})

    def done(self) -> None:
        """Report success."""
        self._send({"ok": True})

    def failed(self, failure: Failure) -> None:
        """Report a failure."""
        self._send({"ok": False, "failure": asdict(failure)})

    def close(self) -> None:
        """Close the pipe, in a process that has nothing to report."""
        os.close(self._descriptor)

    def _send(self, message: dict[str, Any]) -> None:
        os.write(self._descriptor, json.dumps(message).encode() + b"\n")
