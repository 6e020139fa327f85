"""The engine child: reads a mesh, repairs or inspects it, and tells how it went.

Meshes come from strangers and are parsed here and nowhere else, under limits, in a process that may be killed at any
moment. It talks to the worker through one pipe, see `worker.engine_reports`. Results lie in the request's folder.
"""

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import quadpatch.picture  # noqa: F401 - loaded once, before the fork, instead of by every child
from quadpatch.errors import QuadpatchError
from quadpatch.options import RepairOptions
from quadpatch.repair import draw_repair, inspect_file, repair_file
from worker.engine_frame import run_framed
from worker.engine_reports import Reporter
from worker.request import FACTS_NAME, PREVIEW_NAME, REPORT_NAME, EngineRequest


def run_request(folder: Path, descriptor: int) -> None:
    """Do what the request in `folder` asks for, and report how it went through the pipe `descriptor`."""
    run_framed(folder, descriptor, lambda request, reporter: _TASKS[request.task](folder, request, reporter))


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
    try:
        draw_repair(source, output, path)
    except QuadpatchError as error:
        return [f"there is no picture: {error}"]
    return []


def _write_json(path: Path, values: dict[str, Any]) -> None:
    path.write_text(json.dumps(values, allow_nan=False), encoding="utf-8")
