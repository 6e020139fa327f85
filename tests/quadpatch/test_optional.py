import logging

import pytest

from quadpatch.errors import EmptyMeshError, FormatError
from quadpatch.optional import failure_of


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
