"""The command line. stdout is for data, stderr for everything that a person watches.

Tested in `tests/client/test_keeping.py`.
"""

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from client.connection import connected, print_json
from client.exit_codes import exit_codes_text
from client.job_commands import cancel, delete, fetch, pin, wait
from client.options import (
    DEFAULT_URL,
    OUTPUT,
    AllButLargestOption,
    CapOption,
    CloseupsOption,
    HoleChoice,
    HoleOption,
    IncludeBordersOption,
    JsonOption,
    KeyOption,
    MaxDiameterOption,
    MaxPerimeterOption,
    MethodChoice,
    MethodName,
    OutputOption,
    PreviewOption,
    QuietOption,
    ReportOption,
    RuleOption,
    UrlOption,
    WeldToleranceOption,
    make_spec,
    tolerance,
)
from client.outputs import check_stdout
from client.repairing import Task, format_of
from client.repairing import repair as run_repair
from client.screen import Screen
from client.tables import print_holes, print_jobs, print_models
from jobkit.schema import JobState, OutputFormat, Recipe

app = typer.Typer(
    name="quadpatch-client",
    help="Repair holes in 3D scans through a Quadpatch service.",
    epilog=f"Exit codes:\n\n{exit_codes_text()}",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
MeshArgument = Annotated[
    Path,
    typer.Argument(help="Mesh file: PLY, STL, OBJ, OFF, GLB, glTF or 3MF.", exists=True, dir_okay=False, readable=True),
]
_PATCHES = "Patches"
_FITTING = "Fitting a network to the mesh (--method cnn --model self)"


@app.command(epilog=f"Exit codes:\n\n{exit_codes_text()}")
def repair(  # noqa: PLR0913 - one parameter per option of the command line
    mesh: MeshArgument,
    *,
    output: OutputOption,
    method: Annotated[MethodName, typer.Option(help="How holes are filled.")] = "dictionary",
    model: Annotated[
        str | None,
        typer.Option(help="name@version, an alias, or 'self': learned from the mesh itself.", show_default="default"),
    ] = None,
    recipe: Annotated[
        Recipe | None,
        typer.Option(help="How a dictionary is put to use: our way, or exactly the paper's.", show_default="default"),
    ] = None,
    max_diameter: MaxDiameterOption = None,
    max_perimeter: MaxPerimeterOption = None,
    all_but_largest: AllButLargestOption = False,
    hole: HoleOption = None,
    include_borders: IncludeBordersOption = False,
    cap: CapOption = None,
    rule: RuleOption = None,
    weld_tolerance: WeldToleranceOption = None,
    patch_length: Annotated[
        float | None,
        typer.Option(help="Side of a patch, in mesh units.", show_default="auto", rich_help_panel=_PATCHES),
    ] = None,
    resolution: Annotated[
        int | None, typer.Option(help="Bins along a side.", show_default="auto", rich_help_panel=_PATCHES)
    ] = None,
    overlap: Annotated[
        int | None,
        typer.Option(help="k: a quad carries 1 + 4 k patches.", show_default="auto", rich_help_panel=_PATCHES),
    ] = None,
    fit_steps: Annotated[
        int | None,
        typer.Option(help="Fit at most so many steps.", show_default="of the service", rich_help_panel=_FITTING),
    ] = None,
    fit_seconds: Annotated[
        float | None,
        typer.Option(help="Fit at most so long.", show_default="of the service", rich_help_panel=_FITTING),
    ] = None,
    seed: Annotated[int, typer.Option(help="Starts every random choice.")] = 0,
    label: Annotated[str | None, typer.Option(help="A name for the job, for people.")] = None,
    format_: Annotated[
        OutputFormat | None,
        typer.Option(
            "--format",
            help="Format of the repaired mesh.",
            show_default="the suffix of OUTPUT",
            rich_help_panel=OUTPUT,
        ),
    ] = None,
    report: ReportOption = None,
    preview: PreviewOption = None,
    closeups: CloseupsOption = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Let OUTPUT take the place of MESH.", rich_help_panel=OUTPUT)
    ] = False,
    again: Annotated[
        bool, typer.Option("--again", help="Start a new job although the same one is under way or done.")
    ] = False,
    timeout: Annotated[
        float | None, typer.Option(help="Seconds to wait for the job; then it is canceled.", show_default="none")
    ] = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
    quiet: QuietOption = False,
) -> None:
    """Repair a mesh file: upload it, fill its holes, fetch the result."""
    screen = Screen(quiet)
    with connected(screen, url, api_key) as client:
        task = Task(
            source=mesh,
            output=output,
            holes=HoleChoice(max_diameter, max_perimeter, all_but_largest, hole, include_borders, cap, rule),
            method=MethodChoice(method, model, patch_length, resolution, overlap, recipe, fit_steps, fit_seconds),
            rest={
                "seed": seed,
                "weld_tolerance": tolerance(weld_tolerance),
                "label": label,
                "output": {
                    "format": format_ or format_of(output),
                    "preview": preview is not None,
                    "closeups": closeups is not None,
                },
            },
            report=report,
            preview=preview,
            closeups=closeups,
            timeout_s=timeout,
            may_overwrite=overwrite,
            again=again,
        )
        check_stdout([output, report, preview], as_json)
        job = run_repair(client, screen, task)
    if as_json:
        print_json(job)


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
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
    quiet: QuietOption = False,
) -> None:
    """List the holes of a mesh file, and which of them would be filled."""
    screen = Screen(quiet)
    choice = HoleChoice(max_diameter, max_perimeter, all_but_largest, None, include_borders, cap, rule)
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
def models(url: UrlOption = DEFAULT_URL, api_key: KeyOption = None, as_json: JsonOption = False) -> None:
    """List the models that the service knows."""
    with connected(Screen(), url, api_key) as client:
        known = client.models()
    if as_json:
        print_json(known)
    else:
        print_models(_stdout(), known)


@app.command()
def jobs(
    limit: Annotated[int, typer.Option(min=1, help="Most jobs to list.")] = 20,
    state: Annotated[JobState | None, typer.Option(help="Only jobs in this state.")] = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
) -> None:
    """List the latest jobs."""
    with connected(Screen(), url, api_key) as client:
        listed = list(client.jobs(limit, state))
    if as_json:
        typer.echo(json.dumps([job.model_dump(mode="json") for job in listed], indent=2))
    else:
        print_jobs(_stdout(), listed)


for command in (wait, fetch, cancel, delete, pin):
    app.command()(command)


def _stdout() -> Console:
    return Console(highlight=False)
