"""The page of a finished repair, drawn and written; what goes wrong here is a warning in the report."""

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quadpatch.formats.output_files import write_whole
from quadpatch.html_report.page import Pictures, render_page
from quadpatch.html_report.provenance import Start, provenance, provenance_of_task
from quadpatch.preview.comparison import comparison_png
from quadpatch.preview.drawing import draw_widest, invented_in
from quadpatch.preview.sheet import before_after_png
from quadpatch.progress import Progress, no_progress
from quadpatch.repair import RepairedFile
from quadpatch.stages import failure_of, peak_memory_mib
from quadpatch.tasks.result import TaskResult
from quadpatch_rules.acceptance import judge
from quadpatch_rules.coded_warnings import add_warning, warning
from quadpatch_rules.option_words import Tint

# Close-ups in a page: with their base64 at most 5.4 MiB of it.
MOST_PICTURES = 24
MOST_PICTURE_BYTES = 4 << 20
STAGE = "html_report"


@dataclass(frozen=True)
class PageOrder:
    """What a page is made from besides the repair.

    Attributes
    ----------
    start : Start
    output : Path
        The repaired file.
    request : mapping or None
        Who asked, see `quadpatch.html_report.provenance.provenance`.
    overview : Path or None
        A picture of the whole that is drawn already; another one is drawn where it is missing.
    tint : str
        See `quadpatch.preview.drawing.add_picture`.
    """

    start: Start
    output: Path
    request: Mapping[str, Any] | None = None
    overview: Path | None = None
    tint: Tint = "invented"


def add_html_report(repaired: RepairedFile, order: PageOrder, page: Path, progress: Progress = no_progress) -> None:
    """Write the page of a repair.

    Parameters
    ----------
    repaired : RepairedFile
        Its report gets the `provenance`, `acceptance` where the request has limits, the seconds of the stage
        `html_report`, and a warning where there is no page.
    order : PageOrder
    page : Path
    progress : callable
    """
    begun = time.perf_counter()
    progress(STAGE, 0.0)
    _finish(repaired.report, failure_of(lambda: _write(repaired, order, page, progress)), begun)


def add_task_report(result: TaskResult, order: PageOrder, page: Path, progress: Progress = no_progress) -> None:
    """Write the page of a task besides filling holes; the parameters are those of `add_html_report`."""
    begun = time.perf_counter()
    progress(STAGE, 0.0)

    def write() -> None:
        result.report["provenance"] = provenance_of_task(order.start, result, order.output, order.request)
        write_whole(page, render_page(result.report, Pictures(_comparison(result, order))).encode("utf-8"))

    _finish(result.report, failure_of(write), begun)


def _comparison(result: TaskResult, order: PageOrder) -> bytes | None:
    """Read the picture of the whole, or draw it; a page does without one."""
    if order.overview is not None and order.overview.is_file():
        return order.overview.read_bytes()
    found = list[bytes]()
    change = result.changed if result.shift is None else result.shift
    failure = failure_of(lambda: found.append(comparison_png(result.before, result.after, change)))
    if failure is not None:
        add_warning(result.report, warning("no_overview", reason=failure))
    return found[0] if found else None


def _finish(report: dict[str, Any], failure: str | None, begun: float) -> None:
    if failure is not None:
        add_warning(report, warning("no_html_report", reason=failure))
    seconds = round(time.perf_counter() - begun, 4)
    report["stages"].append({"name": STAGE, "seconds": seconds, "peak_memory_mib": peak_memory_mib()})


def _write(repaired: RepairedFile, order: PageOrder, page: Path, progress: Progress) -> None:
    repaired.report["provenance"] = provenance(order.start, repaired, order.output, order.request)
    limits = (order.request or {}).get("acceptance")
    if limits is not None:
        repaired.report["acceptance"] = judge(repaired.report["holes"], limits)
    close_ups = draw_widest(
        repaired, MOST_PICTURES, MOST_PICTURE_BYTES, lambda _stage, fraction: progress(STAGE, fraction), order.tint
    )
    pictures = Pictures(_overview(repaired, order), close_ups)
    write_whole(page, render_page(repaired.report, pictures).encode("utf-8"))


def _overview(repaired: RepairedFile, order: PageOrder) -> bytes | None:
    """Read the picture of the whole, or draw it; a page does without one."""
    if order.overview is not None and order.overview.is_file():
        return order.overview.read_bytes()
    repair, found = repaired.repair, list[bytes]()
    failure = failure_of(lambda: found.append(before_after_png(repair.filled.mesh, invented_in(repair, order.tint))))
    if failure is not None:
        add_warning(repaired.report, warning("no_overview", reason=failure))
    return found[0] if found else None
