"""What the command line of the client loads: HTTP and the wire schema only once it is to do something."""

import subprocess
import sys
from typing import get_args

import pytest

from quadpatch_client.options import JobStateName
from quadpatch_client.schema import JobState
from tests.waiting import GUARD_S

RUN = """
import atexit, sys
atexit.register(lambda: print("loaded", *sorted(sys.modules), file=sys.stderr))
from quadpatch_client.cli import app
app(prog_name="quadpatch-client")
"""
LATER = {"httpx", "pydantic", "quadpatch_client.schema", "rich.progress", "numpy", "quadpatch"}


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["--help"], 0),
        (["repair", "--help"], 0),
        (["jobs", "--help"], 0),
        (["denoise", "--no-such-option"], 2),
        (["jobs", "--state", "no-such-state"], 2),
    ],
)
def test_help_and_wrong_options_load_neither_http_nor_the_schema(arguments: list[str], code: int) -> None:
    command = [sys.executable, "-c", RUN, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=GUARD_S, check=False)
    assert done.returncode == code, done.stderr
    assert set(done.stderr.rpartition("loaded ")[2].split()) & LATER == set()


def test_states_on_the_command_line_are_those_of_the_schema() -> None:
    assert list(get_args(JobStateName)) == [state.value for state in JobState]
