"""What the commands of all tasks do alike: check files, run, draw, report.

Tested in `tests/quadpatch/cli/test_tasks.py`.
"""

import logging
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from quadpatch.cli.messages import clear_errors, progress_bars, say
from quadpatch.cli.reports import closing_words, write_report
from quadpatch.cli.scipy_start import prepare_libraries
from quadpatch.formats.output_files import check_outputs, is_stream
from quadpatch.progress import Progress

if TYPE_CHECKING:
    from quadpatch.html_report.provenance import Start
    from quadpatch.tasks.result import TaskResult


@dataclass(frozen=True)
class Files:
    """Files of a command.

    Attributes
    ----------
    source, output : Path
    report, preview : Path or None
    may_overwrite : bool
        Whether the output may take the place of the source.
    inputs : iterable of Path
        What else is read.
    html : Path or None
        Where the report goes as a page.
    """

    source: Path
    output: Path
    report: Path | None
    preview: Path | None
    may_overwrite: bool = False
    inputs: Iterable[Path] = ()
    html: Path | None = None


def run_task(
    files: Files,
    task: Callable[[Progress], "TaskResult"],
    sentence: Callable[[dict[str, Any], str], str],
    quiet: bool,
) -> None:
    """Run a task from file to file.

    Parameters
    ----------
    files : Files
    task : callable
        Reads and writes the meshes; called as task(progress) once the outputs are known to have a place.
    sentence : callable
        What was done, called as sentence(report, unit of lengths), without a full stop.
    quiet : bool
    """
    with clear_errors(), progress_bars(quiet) as progress:
        others = [path for path in (files.report, files.preview, files.html) if path]
        check_outputs(files.source, files.output, others, may_overwrite=files.may_overwrite, inputs=files.inputs)
        logging.getLogger("quadpatch").addHandler(logging.NullHandler())  # what people read is in the warnings
        prepare_libraries()
        start = _note_start(files.source) if files.html else None
        result = task(progress)
        if files.report and not is_stream(files.report):  # drawing may take the process down
            write_report(result.report, files.report)
        if files.preview:
            from quadpatch.preview.drawing import add_comparison  # noqa: PLC0415  slow to load

            add_comparison(result, files.preview)
        if files.html and start:
            _write_page(result, files, files.html, start)
        write_report(result.report, files.report)
    if not quiet:
        say(f"{sentence(result.report, result.report['length_unit'])}. {closing_words(result.report)}")


def _note_start(source: Path) -> "Start":
    """Note which bytes are worked on, and when: the output may overwrite them."""
    from quadpatch.html_report.provenance import note_start  # noqa: PLC0415  slow to load

    return note_start(source)


def _write_page(result: "TaskResult", files: Files, page: Path, start: "Start") -> None:
    from quadpatch.html_report.writing import PageOrder, add_task_report  # noqa: PLC0415  see above

    add_task_report(result, PageOrder(start, files.output, overview=files.preview), page)


def given(**values: Any) -> dict[str, Any]:
    """Keep the options that were given, those that are groups as far as they were."""
    kept = {name: given(**value) if isinstance(value, dict) else value for name, value in values.items()}
    return {name: value for name, value in kept.items() if value is not None and value != {}}


def vertices(count: int) -> str:
    """Write a number of vertices."""
    return "1 vertex" if count == 1 else f"{count:,} vertices"
