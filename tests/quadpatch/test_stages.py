import logging

import pytest

from quadpatch.errors import EmptyMeshError, FormatError
from quadpatch.stages import Stages, failure_of, harmless


def test_a_stage_tells_when_it_starts_and_ends() -> None:
    told: list[tuple[str, float]] = []
    stages = Stages(lambda name, fraction: told.append((name, fraction)))
    with stages.stage("read"):
        stages.progress("read", 0.5)
    with stages.stage("fill"):
        pass
    assert told == [("read", 0.0), ("read", 0.5), ("read", 1.0), ("fill", 0.0), ("fill", 1.0)]
    assert list(stages.seconds) == ["read", "fill"]
    assert all(seconds >= 0 for seconds in stages.seconds.values())


def test_parts_of_a_stage_report_as_shares_of_it() -> None:
    told: list[tuple[str, float]] = []
    stages = Stages(lambda name, fraction: told.append((name, fraction)))
    with stages.stage("fill"):
        first, second = stages.part(0.0, 0.8), stages.part(0.8, 1.0)
        first(0.5)
        second(0.5)
    assert told[1:-1] == [("fill", 0.4), ("fill", 0.9)]
    stages.part(0.0, 1.0)(0.5)
    Stages().part(0.0, 1.0)(0.5)


def test_a_stage_that_comes_twice_adds_up() -> None:
    stages = Stages()
    with stages.stage("learn"):
        pass
    first = stages.seconds["learn"]
    with stages.stage("learn"):
        pass
    assert stages.seconds["learn"] >= first
    assert list(stages.seconds) == ["learn"]


def test_a_stage_that_fails_has_its_time_but_no_end() -> None:
    told: list[float] = []
    stages = Stages(lambda _, fraction: told.append(fraction))
    with pytest.raises(ValueError, match="no"), stages.stage("fill"):
        raise ValueError("no")
    assert told == [0.0]
    assert "fill" in stages.seconds


def test_a_listener_that_fails_ends_nothing_and_is_not_called_again() -> None:
    calls: list[str] = []

    def listen(stage: str, fraction: float) -> None:
        calls.append(stage)
        raise BrokenPipeError("the terminal is gone")

    stages = Stages(harmless(listen))
    with stages.stage("read"):
        pass
    with stages.stage("fill"):
        pass
    assert calls == ["read"]
    assert list(stages.seconds) == ["read", "fill"]


def raising(error: Exception) -> None:
    raise error


@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (EmptyMeshError("there is no surface to draw"), "there is no surface to draw"),
        (MemoryError(), "there is not enough memory"),
        (OSError(28, "No space left on device", "/secret/path"), "No space left on device"),
        (OSError("no number"), "a file can't be written"),
        (ZeroDivisionError("secret detail"), "an internal error (ZeroDivisionError)"),
        (RecursionError(), "an internal error (RecursionError)"),
    ],
)
def test_whatever_a_step_raises_becomes_a_sentence_and_the_log_has_the_rest(
    error: Exception, sentence: str, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.WARNING):
        assert failure_of(lambda: raising(error)) == sentence
    assert type(error).__name__ in caplog.text


def test_a_step_that_succeeds_says_nothing() -> None:
    done = []
    assert failure_of(lambda: done.append(1)) is None
    assert done == [1]


def test_errors_that_mean_more_than_the_step_pass_and_so_does_an_interrupt() -> None:
    with pytest.raises(FormatError):
        failure_of(lambda: raising(FormatError("no")), passing=(FormatError,))

    def interrupt() -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        failure_of(interrupt)
