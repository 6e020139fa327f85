"""Commands on a job that is there already, by its id.

Tested in `tests/quadpatch_client/test_keeping.py`.
"""

from pathlib import Path
from typing import Annotated

import typer

from quadpatch_client.connection import connected, print_json
from quadpatch_client.options import (
    DEFAULT_URL,
    OUTPUT,
    HtmlOption,
    JsonOption,
    KeyOption,
    OutputOption,
    PdfOption,
    PreviewOption,
    QuietOption,
    ReportOption,
    UrlOption,
)
from quadpatch_client.outputs import check_stdout
from quadpatch_client.repairing import Files
from quadpatch_client.repairing import fetch as fetch_files
from quadpatch_client.screen import Screen

JobArgument = Annotated[str, typer.Argument(help="Id of the job.")]
TimeoutOption = Annotated[
    float | None, typer.Option(help="Seconds to wait; the job goes on after that.", show_default="none")
]


def wait(
    job: JobArgument,
    timeout: TimeoutOption = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
    quiet: QuietOption = False,
) -> None:
    """Wait for the end of a job that was started before; Ctrl-C leaves it alone."""
    screen = Screen(quiet, as_json=as_json)
    with connected(screen, url, api_key) as client, screen.repair() as on_change:
        ended = client.wait(job, on_change, timeout)
    if as_json:
        print_json(ended)
    else:
        screen.say(f"{ended.id}: {ended.state.value}")


def fetch(  # noqa: PLR0913 - one parameter per option of the command line
    job: JobArgument,
    *,
    output: OutputOption,
    report: ReportOption = None,
    preview: PreviewOption = None,
    closeups: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR", help="Folder for the pictures of chosen holes, if the job drew them.", rich_help_panel=OUTPUT
        ),
    ] = None,
    html: HtmlOption = None,
    pdf: PdfOption = None,
    timeout: TimeoutOption = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
    quiet: QuietOption = False,
) -> None:
    """Wait for a job that was started before, and fetch what it made."""
    screen = Screen(quiet, as_json=as_json)
    with connected(screen, url, api_key) as client:
        Files("", output, report, preview, closeups, html, pdf).check()
        check_stdout([output, report, preview, html, pdf], as_json)
        with screen.repair() as on_change:
            ended = client.wait(job, on_change, timeout)
        files = Files(ended.mesh_name or "the mesh", output, report, preview, closeups, html, pdf)
        fetch_files(client, screen, files, ended)
    if as_json:
        print_json(ended)


def cancel(
    job: JobArgument,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
) -> None:
    """Cancel a job."""
    screen = Screen(as_json=as_json)
    with connected(screen, url, api_key) as client:
        canceled = client.cancel(job)
    if as_json:
        print_json(canceled)
    else:
        screen.say(f"{canceled.id}: {canceled.state.value}")


def delete(
    job: JobArgument,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
) -> None:
    """Delete a finished job with its result; there is no way back."""
    screen = Screen()
    with connected(screen, url, api_key) as client:
        client.delete(job)
    screen.say(f"{job}: deleted")


def pin(
    job: JobArgument,
    off: Annotated[bool, typer.Option("--off", help="Leave it to the retention again.")] = False,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
) -> None:
    """Keep a job and its mesh, whatever the retention of the service."""
    screen = Screen()
    with connected(screen, url, api_key) as client:
        client.pin(job, not off)
    screen.say(f"{job}: {'no longer pinned' if off else 'pinned'}")
