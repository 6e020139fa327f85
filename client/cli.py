"""The command line. stdout is for data, stderr for everything that a person watches."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer
from pydantic import BaseModel
from rich.console import Console

from client.errors import ClientError
from client.exits import ExitCode, exit_code_of, exit_codes_text
from client.options import (
    DEFAULT_URL,
    AllButLargestOption,
    CapOption,
    HoleChoice,
    HoleOption,
    IncludeBordersOption,
    JsonOption,
    KeyOption,
    MaxDiameterOption,
    MaxPerimeterOption,
    MethodChoice,
    MethodName,
    QuietOption,
    RuleOption,
    UrlOption,
    WeldToleranceOption,
    make_spec,
    tolerance,
)
from client.repairing import Task, format_of
from client.repairing import repair as run_repair
from client.screen import Screen
from client.sdk import Client
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
_OUTPUT = "What comes back"


@app.command(epilog=f"Exit codes:\n\n{exit_codes_text()}")
def repair(  # noqa: PLR0913 - one parameter per option of the command line
    mesh: MeshArgument,
    *,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Where to put the repaired mesh.", rich_help_panel=_OUTPUT)
    ],
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
            rich_help_panel=_OUTPUT,
        ),
    ] = None,
    report: Annotated[Path | None, typer.Option(help="Where to put the JSON report.", rich_help_panel=_OUTPUT)] = None,
    preview: Annotated[
        Path | None, typer.Option(help="Where to put the before/after picture, a PNG.", rich_help_panel=_OUTPUT)
    ] = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Let OUTPUT take the place of MESH.", rich_help_panel=_OUTPUT)
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
    with _connected(screen, url, api_key) as client:
        task = Task(
            source=mesh,
            output=output,
            holes=HoleChoice(max_diameter, max_perimeter, all_but_largest, hole, include_borders, cap, rule),
            method=MethodChoice(method, model, patch_length, resolution, overlap, recipe, fit_steps, fit_seconds),
            rest={
                "seed": seed,
                "weld_tolerance": tolerance(weld_tolerance),
                "label": label,
                "output": {"format": format_ or format_of(output), "preview": preview is not None},
            },
            report=report,
            preview=preview,
            timeout_s=timeout,
            may_overwrite=overwrite,
        )
        job = run_repair(client, screen, task)
    if as_json:
        _print_json(job)


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
    with _connected(screen, url, api_key) as client:
        with screen.transfer("uploading") as progress:
            uploaded = client.upload(mesh, progress)
        analysed = client.wait_for_mesh(uploaded.id)
        plan = client.plan(make_spec(uploaded.id, choice, MethodChoice("smooth")))
    if as_json:
        _print_json(plan)
    elif analysed.facts is not None:
        print_holes(_stdout(), analysed.facts, plan)


@app.command()
def models(url: UrlOption = DEFAULT_URL, api_key: KeyOption = None, as_json: JsonOption = False) -> None:
    """List the models that the service knows."""
    with _connected(Screen(), url, api_key) as client:
        known = client.models()
    if as_json:
        _print_json(known)
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
    with _connected(Screen(), url, api_key) as client:
        listed = list(client.jobs(limit, state))
    if as_json:
        typer.echo(json.dumps([job.model_dump(mode="json") for job in listed], indent=2))
    else:
        print_jobs(_stdout(), listed)


@app.command()
def cancel(
    job: Annotated[str, typer.Argument(help="Id of the job.")],
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
) -> None:
    """Cancel a job."""
    screen = Screen()
    with _connected(screen, url, api_key) as client:
        canceled = client.cancel(job)
    if as_json:
        _print_json(canceled)
    else:
        screen.say(f"{canceled.id}: {canceled.state.value}")


@app.command()
def delete(
    job: Annotated[str, typer.Argument(help="Id of the job.")],
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
) -> None:
    """Delete a finished job with its result; there is no way back."""
    screen = Screen()
    with _connected(screen, url, api_key) as client:
        client.delete(job)
    screen.say(f"{job}: deleted")


@app.command()
def pin(
    job: Annotated[str, typer.Argument(help="Id of the job.")],
    off: Annotated[bool, typer.Option("--off", help="Leave it to the retention again.")] = False,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
) -> None:
    """Keep a job and its mesh, whatever the retention of the service."""
    screen = Screen()
    with _connected(screen, url, api_key) as client:
        client.pin(job, not off)
    screen.say(f"{job}: {'no longer pinned' if off else 'pinned'}")


@contextmanager
def _connected(screen: Screen, url: str, api_key: str | None) -> Iterator[Client]:
    """Open the service; whatever goes wrong becomes a line on stderr and an exit code."""
    try:
        with Client(url, api_key) as client:
            yield client
    except ClientError as error:
        screen.complain(str(error))
        raise typer.Exit(exit_code_of(error)) from error
    except OSError as error:
        screen.complain(f"{error.filename or 'a file'}: {error.strerror}")
        raise typer.Exit(ExitCode.USAGE) from error
    except KeyboardInterrupt:
        screen.complain("interrupted")
        raise typer.Exit(ExitCode.INTERRUPTED) from None


def _stdout() -> Console:
    return Console(highlight=False)


def _print_json(value: BaseModel) -> None:
    typer.echo(value.model_dump_json(indent=2))
