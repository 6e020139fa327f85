"""Where the command line begins: errors of usage in one line, as JSON with `--json`, and with what was meant.

Tested in `tests/quadpatch_client/test_entry.py`.
"""

import json
import re
import sys
from collections.abc import Sequence
from typing import Any

import typer

from quadpatch_client.cli import app
from quadpatch_client.exit_codes import ExitCode
from quadpatch_client.wording import suggestion

PROGRAM = "quadpatch-client"
# Typer's own base of errors of usage, which it exports under no name.
_ClickException: type[Any] = typer.BadParameter.__mro__[2]
_CHOICE = re.compile(r"'(?P<given>[^']*)' is not one of (?P<known>.+)")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command, and return its exit code.

    Parameters
    ----------
    arguments : list of str, optional
        None: those of the process.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    try:
        code = app(args=words, prog_name=PROGRAM, standalone_mode=False)
    except _ClickException as error:
        return _complain(error, "--json" in words)
    except (typer.Abort, KeyboardInterrupt):
        return ExitCode.INTERRUPTED
    except BrokenPipeError:
        # What reads the output has seen enough, as `head` does.
        sys.stderr.close()
        return ExitCode.OK
    return code if isinstance(code, int) else ExitCode.OK


def _complain(error: Any, as_json: bool) -> int:
    context = getattr(error, "ctx", None)
    command = context.command_path if context is not None else PROGRAM
    message = error.format_message().strip().rstrip(".")
    if not message:  # no command was named, and its help has been printed
        return int(error.exit_code)
    choice = _CHOICE.search(message)
    if choice:
        message += suggestion(choice["given"], re.findall(r"'([^']*)'", choice["known"]))
    if as_json:
        fault = {"code": "usage", "message": message, "exit_code": int(ExitCode.USAGE), "job": None}
        sys.stdout.write(json.dumps({"error": fault}, indent=2) + "\n")
    sys.stderr.write(f"error: {message}\nsee {command} --help\n")
    return int(error.exit_code)


def run() -> None:
    """Run the command of this process and end it."""
    sys.exit(main())
