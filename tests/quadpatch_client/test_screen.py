import io
from typing import Any

import pytest
from rich.console import Console

from quadpatch_client.schema import Job
from quadpatch_client.screen import Screen, status_line
from tests.quadpatch_client.wire_jobs import body


def job(state: str, **more: Any) -> Job:
    return Job.model_validate_json(body(state, 1, **more))


@pytest.mark.parametrize(
    ("state", "more", "line"),
    [
        ("queued", {}, "queued"),
        ("queued", {"queue_position": 3, "eta_s": 100.0}, "queued, number 3 in line, about 2 min left"),
        ("queued", {"queue_position": 1, "waits_for": "memory"}, "waits for memory, number 1 in line"),
        ("running", {}, "starting"),
        ("running", {"stage": "inpaint"}, "inpaint"),
        ("running", {"stage": "inpaint", "eta_s": 0.0}, "inpaint, about 1 s left"),
        ("running", {"stage": "inpaint", "eta_s": 8000.0}, "inpaint, about 2 h 13 min left"),
        ("succeeded_with_warnings", {}, "succeeded with warnings"),
    ],
)
def test_a_line_says_what_is_known(state: str, more: dict[str, Any], line: str) -> None:
    assert status_line(job(state, **more)) == line


def test_a_log_gets_a_line_for_each_stage_and_place_and_none_for_each_percent() -> None:
    text = io.StringIO()
    with Screen(console=Console(file=text)).repair() as show:
        for place in (2, 2, 1):
            show(job("queued", queue_position=place))
        for percent in (10.0, 11.0, 12.0):
            show(job("running", stage="fill", percent=percent, eta_s=9.0))
    assert text.getvalue().splitlines() == [
        "  0.0 %  queued, number 2 in line",
        "  0.0 %  queued, number 1 in line",
        " 10.0 %  fill, about 9 s left",
    ]
