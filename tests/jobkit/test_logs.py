import io
import json
import logging
import threading
from collections.abc import Callable, Iterator
from contextvars import copy_context
from datetime import datetime
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from jobkit.logs import JsonFormatter, current_request_id, log_about, set_up_logs
from jobkit.settings import Settings

log = logging.getLogger("quadpatch.test_logs")


@pytest.fixture(autouse=True)
def untouched_root() -> Iterator[None]:
    """Give the root logger back as it was."""
    root = logging.getLogger()
    handlers, level = root.handlers[:], root.level
    yield
    root.handlers[:] = handlers
    root.setLevel(level)


@pytest.fixture
def written() -> Callable[[str], io.StringIO]:
    def set_up(log_format: str) -> io.StringIO:
        stream = io.StringIO()
        set_up_logs(Settings.model_construct(log_format=log_format), stream)
        return stream

    return set_up


def lines(stream: io.StringIO) -> list[dict[str, Any]]:
    return [json.loads(line) for line in stream.getvalue().splitlines()]


def test_a_line_of_json_says_when_what_and_about_which_job(written: Callable[[str], io.StringIO]) -> None:
    stream = written("json")
    with log_about(worker="w-1"), log_about(job_id="job_1", attempt=2, request_id=None):
        log.warning("lost %d of %d", 1, 3)
    log.info("later")
    first, second = lines(stream)
    moment = datetime.fromisoformat(first.pop("time"))
    assert moment.utcoffset() is not None
    assert first == {
        "level": "warning",
        "logger": "quadpatch.test_logs",
        "message": "lost 1 of 3",
        "job_id": "job_1",
        "attempt": 2,
        "worker": "w-1",
    }
    assert second.keys() == {"time", "level", "logger", "message"}


def test_a_line_of_text_ends_with_what_it_is_about(written: Callable[[str], io.StringIO]) -> None:
    stream = written("text")
    with log_about(attempt=2, job_id="job_1"):
        log.warning("lost")
    log.warning("found")
    lost, found = stream.getvalue().splitlines()
    assert lost.endswith(" WARNING quadpatch.test_logs: lost [job_id=job_1 attempt=2]")
    assert found.endswith(" WARNING quadpatch.test_logs: found")


@given(message=st.text())
def test_a_message_is_one_line_of_json_whatever_it_says(message: str) -> None:
    record = logging.LogRecord("n", logging.INFO, "p", 1, message, (), None)
    line = JsonFormatter().format(record)
    assert len(line.splitlines()) == 1 or set(message) & set("\x1c\x1d\x1e\x85\u2028\u2029")
    assert "\n" not in line
    assert json.loads(line)["message"] == message


def test_a_traceback_stays_in_its_line(written: Callable[[str], io.StringIO]) -> None:
    stream = written("json")
    try:
        raise ValueError("no such edge")
    except ValueError:
        log.exception("it failed")
    (line,) = lines(stream)
    assert line["traceback"].endswith("ValueError: no such edge")


def test_a_thread_knows_what_it_works_for_only_in_a_copy_of_the_context(written: Callable[[str], io.StringIO]) -> None:
    stream = written("json")
    with log_about(job_id="job_1"):
        for work in (lambda: log.warning("bare"), lambda: copy_context().run(log.warning, "x")):
            thread = threading.Thread(target=work)
            thread.start()
            thread.join()
        thread = threading.Thread(target=copy_context().run, args=(log.warning, "copied"))
        thread.start()
        thread.join()
    assert [line.get("job_id") for line in lines(stream)] == [None, None, "job_1"]


def test_the_request_is_known_within_its_block_alone() -> None:
    assert current_request_id() is None
    with log_about(request_id="station-4"):
        assert current_request_id() == "station-4"
    assert current_request_id() is None


def test_an_unknown_field_is_refused() -> None:
    with pytest.raises(ValueError, match="jobid"), log_about(jobid="job_1"):
        pass


def test_the_web_server_logs_like_everything_else(written: Callable[[str], io.StringIO]) -> None:
    access = logging.getLogger("uvicorn.access")
    access.addHandler(logging.StreamHandler(io.StringIO()))
    stream = written("json")
    with log_about(request_id="station-4"):
        access.info('%s - "%s %s HTTP/%s" %d', "127.0.0.1:1", "GET", "/v1/jobs", "1.1", 200)
    (line,) = lines(stream)
    assert line["message"] == '127.0.0.1:1 - "GET /v1/jobs HTTP/1.1" 200'
    assert line["request_id"] == "station-4"
