"""What every command does: open the service, turn errors into exit codes, print JSON."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import typer

from quadpatch_client.errors import ClientError
from quadpatch_client.exit_codes import ExitCode, error_code, exit_code_of
from quadpatch_client.screen import Screen

if TYPE_CHECKING:
    from pydantic import BaseModel

    from quadpatch_client.sdk import Client

# How long a request is repeated while the line is down, in seconds.
PATIENCE_S = 60.0


@contextmanager
def connected(screen: Screen, url: str, api_key: str | None, patience_s: float = PATIENCE_S) -> Iterator["Client"]:
    """Open the service; whatever goes wrong becomes a line on stderr and an exit code."""
    from quadpatch_client.sdk import Client  # noqa: PLC0415  HTTP and the wire schema take longer to load than --help takes

    try:
        with Client(url, api_key, patience_s) as client:
            yield client
    except ClientError as error:
        exit_code = exit_code_of(error)
        screen.fail(str(error), exit_code, error_code(error), getattr(getattr(error, "job", None), "id", None))
        raise typer.Exit(exit_code) from error
    except OSError as error:
        screen.fail(f"{error.filename or 'a file'}: {error.strerror}", ExitCode.USAGE, "usage")
        raise typer.Exit(ExitCode.USAGE) from error
    except KeyboardInterrupt:
        screen.fail("interrupted", ExitCode.INTERRUPTED, "interrupted")
        raise typer.Exit(ExitCode.INTERRUPTED) from None


def print_json(value: "BaseModel") -> None:
    """Print an answer as JSON on stdout."""
    typer.echo(value.model_dump_json(indent=2))
