"""The command line. stdout is for data, stderr for everything that a person watches.

Tested in `tests/quadpatch_client/test_keeping.py`.
"""

import json
from importlib.metadata import version
from typing import Annotated

import typer
from rich.console import Console

from quadpatch_client.batch_command import batch
from quadpatch_client.catalogue_commands import keys, models, train
from quadpatch_client.connection import connected, print_json
from quadpatch_client.doctor_command import doctor
from quadpatch_client.exit_codes import exit_codes_text
from quadpatch_client.job_commands import cancel, delete, fetch, pin, wait
from quadpatch_client.method_options import (
    EffortOption,
    FitSecondsOption,
    FitStepsOption,
    MethodOption,
    ModelOption,
    OverlapOption,
    PatchLengthOption,
    PresetOption,
    RecipeOption,
    ResolutionOption,
)
from quadpatch_client.moments import moment_of
from quadpatch_client.options import (
    DEFAULT_URL,
    AgainOption,
    AllButLargestOption,
    BridgeOption,
    CapOption,
    CloseupsOption,
    ColoursOption,
    FormatOption,
    HoleChoice,
    HoleOption,
    HtmlOption,
    IncludeBordersOption,
    JobStateName,
    JsonOption,
    KeyOption,
    LabelOption,
    LengthUnitOption,
    MaxDiameterOption,
    MaxPerimeterOption,
    MeshArgument,
    MethodChoice,
    OutputOption,
    OverwriteOption,
    PdfOption,
    PreviewOption,
    PriorityOption,
    QuietOption,
    ReportOption,
    RuleOption,
    SavedRuleOption,
    SeedOption,
    TaskName,
    TimeoutOption,
    TintOption,
    UrlOption,
    WeldToleranceOption,
    tolerance,
)
from quadpatch_client.plan_command import plan
from quadpatch_client.repairing import Task, format_of
from quadpatch_client.rule_commands import rules
from quadpatch_client.running import Connection, run
from quadpatch_client.screen import Screen
from quadpatch_client.tables import print_holes, print_jobs
from quadpatch_client.task_commands import decode, denoise, encode, restore
from quadpatch_client.watch_command import watch

app = typer.Typer(
    name="quadpatch-client",
    help="Repair 3D scans through a Quadpatch service: fill holes, restore vertices, take noise away, compress.",
    epilog=f"Exit codes:\n\n{exit_codes_text()}",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)


def _show_version(is_asked: bool) -> None:
    if is_asked:
        typer.echo(f"quadpatch-client {version('quadpatch-client')}")
        raise typer.Exit


@app.callback()
def _options(
    _: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Print the version and end.")
    ] = False,
) -> None:
    """Take the options of the program itself."""


@app.command(epilog=f"Exit codes:\n\n{exit_codes_text()}")
def repair(  # noqa: PLR0913 - one parameter per option of the command line
    mesh: MeshArgument,
    *,
    output: OutputOption,
    effort: EffortOption = None,
    method: MethodOption = None,
    model: ModelOption = None,
    recipe: RecipeOption = None,
    max_diameter: MaxDiameterOption = None,
    max_perimeter: MaxPerimeterOption = None,
    all_but_largest: AllButLargestOption = False,
    hole: HoleOption = None,
    include_borders: IncludeBordersOption = False,
    cap: CapOption = None,
    rule: RuleOption = None,
    bridge: BridgeOption = None,
    saved_rule: SavedRuleOption = None,
    weld_tolerance: WeldToleranceOption = None,
    patch_length: PatchLengthOption = None,
    resolution: ResolutionOption = None,
    overlap: OverlapOption = None,
    preset: PresetOption = None,
    fit_steps: FitStepsOption = None,
    fit_seconds: FitSecondsOption = None,
    seed: SeedOption = 0,
    label: LabelOption = None,
    priority: PriorityOption = None,
    format_: FormatOption = None,
    colours: ColoursOption = None,
    length_unit: LengthUnitOption = None,
    report: ReportOption = None,
    preview: PreviewOption = None,
    closeups: CloseupsOption = None,
    html: HtmlOption = None,
    pdf: PdfOption = None,
    tint: TintOption = "invented",
    overwrite: OverwriteOption = False,
    again: AgainOption = False,
    timeout: TimeoutOption = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
    quiet: QuietOption = False,
) -> None:
    """Repair a mesh file: upload it, fill its holes, fetch the result."""

    def task() -> Task:
        return Task(
            source=mesh,
            output=output,
            holes=HoleChoice(max_diameter, max_perimeter, all_but_largest, hole, include_borders, cap, rule, bridge),
            method=MethodChoice(
                method, model, patch_length, resolution, overlap, recipe, fit_steps, fit_seconds, preset, effort
            ),
            rest={
                "seed": seed,
                "rule": saved_rule,
                "weld_tolerance": tolerance(weld_tolerance),
                "colours": colours,
                "length_unit": length_unit,
                "label": label,
                "priority": priority or "normal",
                "output": {
                    "format": format_ or format_of(output),
                    "preview": preview is not None,
                    "closeups": closeups is not None,
                    "html_report": html is not None or pdf is not None,
                    "tint": tint,
                },
            },
            report=report,
            preview=preview,
            closeups=closeups,
            html=html,
            pdf=pdf,
            timeout_s=timeout,
            may_overwrite=overwrite,
            again=again,
        )

    run(task, Connection(url, api_key, quiet, as_json))


@app.command()
def holes(  # noqa: PLR0913 - one parameter per option of the command line
    mesh: MeshArgument,
    *,
    max_diameter: MaxDiameterOption = None,
    max_perimeter: MaxPerimeterOption = None,
    all_but_largest: AllButLargestOption = False,
    include_borders: IncludeBordersOption = False,
    cap: CapOption = None,
    rule: RuleOption = None,
    bridge: BridgeOption = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
    quiet: QuietOption = False,
) -> None:
    """List the holes of a mesh file, and which of them would be filled."""
    from quadpatch_client.spec import make_spec  # noqa: PLC0415  loads the wire schema, which --help does without

    screen = Screen(quiet, as_json=as_json)
    choice = HoleChoice(max_diameter, max_perimeter, all_but_largest, None, include_borders, cap, rule, bridge)
    with connected(screen, url, api_key) as client:
        with screen.transfer("uploading") as progress:
            uploaded = client.upload(mesh, progress)
        analysed = client.wait_for_mesh(uploaded.id)
        plan = client.plan(make_spec(uploaded.id, choice, MethodChoice("smooth")))
    if as_json:
        print_json(plan)
    elif analysed.facts is not None:
        print_holes(_stdout(), analysed.facts, plan)


@app.command()
def jobs(  # noqa: PLR0913, PLR0917 - one parameter per option of the command line
    limit: Annotated[int, typer.Option(min=1, help="Most jobs to list.")] = 20,
    state: Annotated[JobStateName | None, typer.Option(help="Only jobs in this state.")] = None,
    label: Annotated[str | None, typer.Option(help="Only jobs with this label; * stands for any characters.")] = None,
    filename: Annotated[str | None, typer.Option(help="Only jobs on files of this name; * as for --label.")] = None,
    task: Annotated[TaskName | None, typer.Option(help="Only jobs of this task.")] = None,
    since: Annotated[
        str | None,
        typer.Option(metavar="AGE|TIME", help="Only jobs made since then: 90m, 12h, 7d, or 2026-11-30T08:00Z."),
    ] = None,
    batch_id: Annotated[str | None, typer.Option("--batch", help="Only jobs of this batch of the service.")] = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
) -> None:
    """List the latest jobs."""
    from quadpatch_client.schema import JobState  # noqa: PLC0415  see holes

    with connected(Screen(as_json=as_json), url, api_key) as client:
        given = {"label": label, "filename": filename, "task": task, "batch_id": batch_id}
        given["created_since"] = None if since is None else moment_of(since).isoformat()
        search = {name: text for name, text in given.items() if text is not None}
        listed = list(client.jobs(limit, JobState(state) if state else None, **search))
    if as_json:
        typer.echo(json.dumps([job.model_dump(mode="json") for job in listed], indent=2))
    else:
        print_jobs(_stdout(), listed)


for task_command in (restore, denoise, encode, decode):
    app.command(epilog=f"Exit codes:\n\n{exit_codes_text()}")(task_command)
app.command()(plan)
app.command()(doctor)
for folder_command in (batch, watch, train):
    app.command(epilog=f"Exit codes:\n\n{exit_codes_text()}")(folder_command)
for command in (wait, fetch, cancel, delete, pin, models):
    app.command()(command)
app.add_typer(rules)
app.add_typer(keys)


def _stdout() -> Console:
    return Console(highlight=False)
