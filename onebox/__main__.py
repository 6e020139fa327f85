"""`python -m onebox serve` runs a local stack; `python -m onebox demo` repairs a real scan with one.

Tested in `tests/onebox/test_local_stack.py`.
"""

import sys
from pathlib import Path
from typing import Annotated

import typer

from onebox.demo import demo as run_demo
from onebox.errors import OneBoxError
from onebox.local_stack import LocalStack, check_settings, default_workers, usable_port
from onebox.serve import serve as run_serve

_FAILED = 1

app = typer.Typer(
    help="Local stack: Valkey, dispatcher, API and workers on this machine, started and watched by one command.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


@app.command()
def serve(
    host: Annotated[
        str, typer.Option(envvar="QUADPATCH_HOST", help="Address to listen on; any but loopback needs API keys.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port to listen on; 0: any free one.")] = 8000,
    workers: Annotated[str, typer.Option(help="Count of worker processes, or 'auto'.")] = "auto",
    data: Annotated[Path, typer.Option(help="Folder for database, objects, queue and logs.")] = Path("var"),
) -> None:
    """Run queue, API and workers until Ctrl-C."""
    if workers != "auto" and not (workers.isdecimal() and 1 <= int(workers) <= 256):
        raise typer.BadParameter(f"must be 'auto' or a count from 1 to 256; it is {workers!r}", param_hint="--workers")
    try:
        check_settings(host, data)
        n_workers = default_workers() if workers == "auto" else int(workers)
        run_serve(LocalStack(data, host, usable_port(host, port), n_workers), typer.echo)
    except OneBoxError as error:
        _fail(error)


@app.command()
def demo(
    folder: Annotated[Path, typer.Option(help="Where to leave the results.")] = Path("demo"),
    stay: Annotated[
        bool | None,
        typer.Option(
            help="Open the page in the browser at the end, and serve it until Ctrl-C. Default: on a terminal.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Repair a real scan and a relief over HTTP: needs nothing but this installation, and a minute."""
    try:
        run_demo(folder, stays=sys.stdout.isatty() and sys.stdin.isatty() if stay is None else stay)
    except OneBoxError as error:
        _fail(error)
    except KeyboardInterrupt:
        typer.echo("interrupted", err=True)
        raise typer.Exit(130) from None


def _fail(error: OneBoxError) -> None:
    typer.echo(f"error: {error}", err=True)
    raise typer.Exit(_FAILED) from error


if __name__ == "__main__":
    # Lines appear when they are said, also in a file.
    sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]
    app(prog_name="python -m onebox")
