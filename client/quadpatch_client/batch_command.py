"""The command `batch`.

Tested in `tests/integration/test_batch.py`.
"""

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from quadpatch_client.batch import JOURNAL, Batch
from quadpatch_client.batch_summary import figures, print_summary, row_text, write_csv
from quadpatch_client.connection import connected
from quadpatch_client.errors import UnreachableError, UsageError
from quadpatch_client.exit_codes import ExitCode
from quadpatch_client.file_repair import Row
from quadpatch_client.folder_files import (
    inner_folders,
    mesh_files,
    passed_over,
    passed_over_in_words,
    plans_in,
    remove_partial_files,
)
from quadpatch_client.folder_options import (
    FolderArgument,
    FolderHtmlOption,
    FolderPreviewOption,
    ParallelOption,
    WhereOption,
    job_options,
)
from quadpatch_client.journal import Journal, one_client_alone
from quadpatch_client.method_options import EffortOption, MethodOption, ModelOption
from quadpatch_client.options import (
    DEFAULT_URL,
    CapOption,
    FormatOption,
    HoleChoice,
    IncludeBordersOption,
    JsonOption,
    KeyOption,
    LabelOption,
    LengthUnitOption,
    MaxDiameterOption,
    MaxPerimeterOption,
    MethodChoice,
    PriorityOption,
    QuietOption,
    RuleOption,
    SavedRuleOption,
    SeedOption,
    UrlOption,
)
from quadpatch_client.screen import Screen

# A batch runs for hours: a service that is away for some minutes is waited for.
_PATIENCE_S = 600.0


def batch(  # noqa: PLR0913 - one parameter per option of the command line
    folder: FolderArgument,
    *,
    out: Annotated[
        Path, typer.Option("--out", "-o", metavar="DIR", help="Folder for what comes back; made where it is missing.")
    ],
    where: WhereOption = None,
    recursive: Annotated[
        bool, typer.Option("--recursive", "-r", help="Take folders in DIR, too.", rich_help_panel="Which files")
    ] = False,
    parallel: ParallelOption = 4,
    effort: EffortOption = None,
    method: MethodOption = None,
    model: ModelOption = None,
    max_diameter: MaxDiameterOption = None,
    max_perimeter: MaxPerimeterOption = None,
    include_borders: IncludeBordersOption = False,
    cap: CapOption = None,
    rule: RuleOption = None,
    saved_rule: SavedRuleOption = None,
    seed: SeedOption = 0,
    label: LabelOption = None,
    priority: PriorityOption = "bulk",
    format_: FormatOption = None,
    length_unit: LengthUnitOption = None,
    html: FolderHtmlOption = False,
    preview: FolderPreviewOption = False,
    csv: Annotated[
        Path | None, typer.Option("--csv", help="Where to put the summary.", show_default="OUT/summary.csv")
    ] = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
    quiet: QuietOption = False,
) -> None:
    """Repair all meshes of a folder. Run again, it goes on where it was ended, and tries again what failed."""
    screen = Screen(quiet, as_json=as_json)
    with connected(screen, url, api_key, _PATIENCE_S) as client:
        options = job_options(
            HoleChoice(max_diameter, max_perimeter, False, None, include_borders, cap, rule),
            MethodChoice(method, model, effort=effort),
            {
                "seed": seed,
                "label": label,
                "priority": priority or "bulk",
                "length_unit": length_unit,
                "rule": saved_rule,
                "format": format_,
            },
            where,
            *(name for name, is_wanted in (("html_report", html), ("preview", preview)) if is_wanted),
        )
        _check_folders(folder, out)
        others = passed_over(folder, recursive, out)
        inner = [] if recursive else inner_folders(folder, out)
        if inner:
            others["folders: --recursive takes them"] = inner
        if others:
            screen.say(f"passed over: {passed_over_in_words(others)}")
        sources = mesh_files(folder, recursive, out)
        plans = plans_in(sources, folder, out, format_, with_html=html, with_preview=preview)
        out.mkdir(parents=True, exist_ok=True)
        with one_client_alone(out), Journal(out / JOURNAL) as journal:
            remove_partial_files(out)
            work = Batch(client, plans, options, journal, parallel)
            rows = _run(work, screen, f"quadpatch-client batch {folder} --out {out}")
            write_csv(csv or out / "summary.csv", rows)
    if as_json:
        typer.echo(json.dumps([figures(row) for row in rows], indent=2))
    elif not quiet:
        print_summary(Console(highlight=False), rows)
        screen.say(f"wrote {csv or out / 'summary.csv'}", style="green")
    if any(row.state == "failed" for row in rows):
        raise typer.Exit(ExitCode.JOB_FAILED)


def _run(work: Batch, screen: Screen, command: str) -> list[Row]:
    """Run a batch, telling what comes of each file."""
    n_before = len(work.finished())
    if n_before:
        screen.say(f"{n_before:,} of {len(work.plans):,} files were finished before")
    try:
        with screen.counting("repairing files", n_before, len(work.plans)) as step:

            def tell(row: Row) -> None:
                step(row_text(row))

            return work.run(tell)
    except (UnreachableError, KeyboardInterrupt):
        screen.complain(f"not all files are finished; `{command}` with the same options goes on")
        raise


def _check_folders(folder: Path, out: Path) -> None:
    if out.resolve() == folder.resolve():
        raise UsageError(f"--out is {folder} itself: results would take the place of the scans")
    if out.exists() and not out.is_dir():
        raise UsageError(f"{out} is no folder")
