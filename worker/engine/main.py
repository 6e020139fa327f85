"""The engine child: works on or inspects a mesh, or proves a model, and reports the outcome.

Untrusted meshes and models are parsed here and nowhere else, under limits, in a process that may be
killed at any moment. It talks to the worker through one pipe, see `worker.engine.reports`. Results lie in the
request's folder.
"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from quadpatch.calibration.kept import KeptCalibrations
from quadpatch.formats.output_files import write_whole
from quadpatch.html_report.provenance import note_start
from quadpatch.html_report.writing import PageOrder, add_html_report, add_task_report
from quadpatch.inpainters.proof import prove_model
from quadpatch.options import RepairOptions
from quadpatch.preview.drawing import add_close_up_archive, add_comparison, add_picture
from quadpatch.processes import ProcessPool
from quadpatch.recipes.fairing_energies import CALIBRATED_ENERGIES
from quadpatch.repair import repair_and_keep
from quadpatch.stages import failure_of
from quadpatch.tasks.inspect import inspect_any
from quadpatch_rules.garbage_collection import collect_seldom
from worker.engine import preloading  # noqa: F401  loads what would else be loaded in each engine
from worker.engine.entry import run_confined
from worker.engine.reports import Reporter
from worker.engine.request import (
    CALIBRATION_NAME,
    CLOSE_UPS_NAME,
    FACTS_NAME,
    PAGE_NAME,
    PREVIEW_NAME,
    REPORT_NAME,
    EngineRequest,
    EngineTask,
)
from worker.engine.tasks import MESH_TASKS, train
from worker.engine.views import write_view


def run_request(folder: Path, descriptor: int) -> None:
    """Do what the request in `folder` asks for, and report the outcome through the pipe `descriptor`."""
    collect_seldom()
    run_confined(folder, descriptor, lambda *about: _TASKS[about[0].task](folder, *about))


def _repair(folder: Path, request: EngineRequest, reporter: Reporter, pool: ProcessPool) -> None:
    source, output = folder / request.source, folder / request.output
    options = RepairOptions.from_dict(request.options)
    kept = _kept_calibrations(folder, request.scan)
    reference = folder / request.reference if request.reference else None
    start = None if request.html_report is None else note_start(source)
    repaired = repair_and_keep(
        source, output, request.model, options, reporter.progress, request.model_card, kept, pool, reference
    )
    _write_json(folder / REPORT_NAME, repaired.report)
    if kept.has_new:
        failure_of(lambda: write_whole(folder / CALIBRATION_NAME, kept.written()))
    reporter.delivered()
    if request.with_preview:
        reporter.progress("preview", 0.0)
        add_picture(repaired, folder / PREVIEW_NAME, request.tint)
        _write_json(folder / REPORT_NAME, repaired.report)
    if request.with_close_ups:
        reporter.progress("closeups", 0.0)
        add_close_up_archive(repaired, folder / CLOSE_UPS_NAME, reporter.progress, tint=request.tint)
        _write_json(folder / REPORT_NAME, repaired.report)
    if start is not None:
        order = PageOrder(start, output, request.html_report, folder / PREVIEW_NAME, request.tint)
        add_html_report(repaired, order, folder / PAGE_NAME, reporter.progress)
        _write_json(folder / REPORT_NAME, repaired.report)


def _kept_calibrations(folder: Path, scan: str) -> KeptCalibrations:
    """Read what earlier repairs kept; the worker has checked the file, and says what is wrong with it."""
    path = folder / CALIBRATION_NAME
    return (
        KeptCalibrations.read(path.read_bytes(), CALIBRATED_ENERGIES, scan) if path.exists() else KeptCalibrations(scan)
    )


def _inspect(folder: Path, request: EngineRequest, reporter: Reporter, _pool: ProcessPool) -> None:
    reporter.progress("read", 0.0)
    _write_json(folder / FACTS_NAME, inspect_any(folder / request.source))


def _prove(_folder: Path, request: EngineRequest, reporter: Reporter, _pool: ProcessPool) -> None:
    reporter.progress("prove", 0.0)
    prove_model(request.model, request.model_card)


def _view(folder: Path, request: EngineRequest, reporter: Reporter, _pool: ProcessPool) -> None:
    reporter.progress("view", 0.0)
    write_view(folder, request)


def _do_task(folder: Path, request: EngineRequest, reporter: Reporter, _pool: ProcessPool) -> None:
    start = None if request.html_report is None else note_start(folder / request.source)
    done = MESH_TASKS[request.task](folder, request, reporter.progress)
    _write_json(folder / REPORT_NAME, done.report)
    reporter.delivered()
    if request.with_preview:
        reporter.progress("preview", 0.0)
        add_comparison(done, folder / PREVIEW_NAME)
        _write_json(folder / REPORT_NAME, done.report)
    if start is not None:
        order = PageOrder(start, folder / request.output, request.html_report, folder / PREVIEW_NAME)
        add_task_report(done, order, folder / PAGE_NAME, reporter.progress)
        _write_json(folder / REPORT_NAME, done.report)


def _train(folder: Path, request: EngineRequest, reporter: Reporter, _pool: ProcessPool) -> None:
    _write_json(folder / REPORT_NAME, train(folder, request, reporter.progress))


_TASKS: dict[EngineTask, Callable[[Path, EngineRequest, Reporter, ProcessPool], None]] = {
    "repair": _repair,
    **dict.fromkeys(MESH_TASKS, _do_task),
    "train": _train,
    "inspect": _inspect,
    "prove": _prove,
    "view": _view,
}


def _write_json(path: Path, values: dict[str, Any]) -> None:
    """Write a file that is whole at any moment: the engine may be killed while it writes the second report."""
    write_whole(path, json.dumps(values, allow_nan=False).encode())
