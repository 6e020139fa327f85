"""From a command's task to its end: connect, run it, print what was asked for.

Tested in `tests/quadpatch_client/test_task_commands.py`.
"""

from collections.abc import Callable
from dataclasses import dataclass

from quadpatch_client.connection import connected, print_json
from quadpatch_client.outputs import check_stdout
from quadpatch_client.repairing import Task, repair
from quadpatch_client.screen import Screen


@dataclass(frozen=True)
class Connection:
    """Which service a command talks to, and what it prints.

    Attributes
    ----------
    url : str
    api_key : str or None
    quiet, as_json : bool
    """

    url: str
    api_key: str | None
    quiet: bool
    as_json: bool


def run(make: Callable[[], Task], connection: Connection) -> None:
    """Run one task through the service; wrong usage ends the command like any other error.

    Parameters
    ----------
    make : callable
        Builds the task from what was typed.
    connection : Connection
    """
    screen = Screen(connection.quiet, as_json=connection.as_json)
    with connected(screen, connection.url, connection.api_key) as client:
        task = make()
        check_stdout([task.output, task.report, task.preview, task.html, task.pdf], connection.as_json)
        job = repair(client, screen, task)
    if connection.as_json:
        print_json(job)
