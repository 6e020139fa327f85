"""The engine child: reads a mesh, repairs or inspects it, and tells how it went.

Meshes come from strangers and are parsed here and nowhere else, under limits, in a process that may be killed at any
moment. It talks to the worker through one pipe, in JSON lines: `{"stage", "fraction"}` while it works, and at last
`{"ok": true}` or `{"ok": false, "failure": {...}}`. Results lie in the folder of the request.
"""

import json
import os
import time
import traceback
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from quadpatch.formats.reading import read_scan
from quadpatch.picture import render_before_after
from quadpatch.repair import inspect_file, repair_file

from quadpatch.errors import QuadpatchError
from quadpatch.options import RepairOptions
from quadpatch.types import TriangleMesh
from worker.failures import Failure, from_os_error, over_memory
from worker.request import FACTS_NAME, PREVIEW_NAME, REPORT_NAME, EngineRequest

# More reports than this only cost time on both sides.
_REPORT_INTERVAL_S = 0.05


class Reporter:
    """Writes JSON lines into the pipe and remembers the stage."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._last = 0.0
        self.stage: str | None = None

    def progress(self, stage: str, fraction: float) -> None:
        """Report progress, thinned out; a new stage is always reported."""
        now = time.monotonic()
        if stage == self.stage and now - self._last < _REPORT_INTERVAL_S:
            return
        self.stage, self._last = stage, now
        self._send({"stage": stage, "fraction": round(float(fraction), 4)})

    def done(self) -> None:
        """Report success."""
        self._send({"ok": True})

    def failed(self, failure: Failure) -> None:
        """Report a failure."""
        self._send({"ok": False, "failure": asdict(failure)})

    def _send(self, message: dict[str, Any]) -> None:
        os.write(self._descriptor, json.dumps(message).encode() + b"\n")


def run_request(folder: Path, descriptor: int) -> None:
    """Do what the request in `folder` asks for, and report how it went through the pipe `descriptor`."""
    reporter = Reporter(descriptor)
    request = EngineRequest.load(folder)
    try:
        request.limits.apply()
        _TASKS[request.task](folder, request, reporter)
    except QuadpatchError as error:
        reporter.failed(Failure(error.code, _without_paths(str(error), folder), reporter.stage))
    except MemoryError:
        reporter.failed(over_memory(request.limits.memory_mb, reporter.stage))
    except OSError as error:
        traceback.print_exc()
        reporter.failed(from_os_error(error, reporter.stage))
    except Exception:  # noqa: BLE001 - the outermost frame of the engine; the log gets the traceback
        traceback.print_exc()
        reporter.failed(Failure("engine_error", "the engine met an error that nobody foresaw", reporter.stage))
    else:
        reporter.done()


def _repair(folder: Path, request: EngineRequest, reporter: Reporter) -> None:
    source, output = folder / request.source, folder / request.output
    options = RepairOptions.from_dict(request.options)
    report = repair_file(source, output, request.model, options, reporter.progress)
    if request.with_preview:
        reporter.progress("preview", 0.0)
        started = time.perf_counter()
        report["warnings"] = [*report["warnings"], *_preview(source, output, folder / PREVIEW_NAME)]
        report["stages"] = [*report["stages"], {"name": "preview", "seconds": time.perf_counter() - started}]
    _write_json(folder / REPORT_NAME, report)


def _inspect(folder: Path, request: EngineRequest, reporter: Reporter) -> None:
    reporter.progress("read", 0.0)
    _write_json(folder / FACTS_NAME, inspect_file(folder / request.source))


_TASKS: dict[str, Callable[[Path, EngineRequest, Reporter], None]] = {"repair": _repair, "inspect": _inspect}


def _preview(source: Path, output: Path, path: Path) -> list[str]:
    """Draw the picture; a repair without one is still a repair, so what goes wrong here is a warning."""
    before, after = read_scan(source), read_scan(output)
    # Measured faces come first and in order: all that follows is invented.
    invented = np.arange(len(after.triangles)) >= len(before.triangles)
    try:
        render_before_after(
            TriangleMesh(before.vertices, before.triangles),
            TriangleMesh(after.vertices, after.triangles),
            invented,
            path,
        )
    except QuadpatchError as error:
        return [f"there is no picture: {error}"]
    return []


def _write_json(path: Path, values: dict[str, Any]) -> None:
    path.write_text(json.dumps(values, allow_nan=False), encoding="utf-8")


def _without_paths(message: str, folder: Path) -> str:
    """Take the worker's own folder out of a message that goes to a client."""
    return message.replace(f"{folder}{os.sep}", "").replace(str(folder), "")
