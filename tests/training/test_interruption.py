import signal
import threading

import pytest

from training.interruption import SIGNALS, stop_on_signal


@pytest.mark.parametrize("number", SIGNALS)
def test_the_first_signal_is_a_wish_and_the_second_one_counts(number: int) -> None:
    before = {own: signal.getsignal(own) for own in SIGNALS}
    with stop_on_signal() as is_stopping:
        assert not is_stopping()
        signal.raise_signal(number)
        assert is_stopping()
        assert {own: signal.getsignal(own) for own in SIGNALS} == before
    assert {own: signal.getsignal(own) for own in SIGNALS} == before


def test_handlers_are_put_back_when_nothing_happened() -> None:
    before = signal.getsignal(signal.SIGINT)
    with stop_on_signal() as is_stopping:
        assert signal.getsignal(signal.SIGINT) != before
    assert signal.getsignal(signal.SIGINT) == before
    assert not is_stopping()


def test_other_threads_are_never_asked_to_stop() -> None:
    answers = []

    def work() -> None:
        with stop_on_signal() as is_stopping:
            answers.append(is_stopping())

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert answers == [False]
