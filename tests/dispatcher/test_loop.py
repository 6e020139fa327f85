import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from dispatcher.loop import Dispatch, PeriodicTask
from jobkit.database.leadership import Leadership, current_leader
from jobkit.database.session import Database
from jobkit.errors import QueueUnavailableError
from tests.waiting import GUARD_S

NAME = "dispatcher"


class Counter:
    """A periodic task that counts its turns."""

    def __init__(self, error: Exception | None = None) -> None:
        self.turns = 0
        self.enough = threading.Event()
        self.error = error

    def __call__(self, is_over: Callable[[], bool]) -> str:
        assert not is_over()
        self.turns += 1
        if self.turns >= 3:
            self.enough.set()
        if self.error is not None:
            raise self.error
        return "done"


@contextmanager
def running(database: Database, holder: str, *tasks: PeriodicTask) -> Iterator[Dispatch]:
    dispatch = Dispatch(Leadership(database, NAME, holder, lease_s=GUARD_S), 0.1, tasks)
    thread = threading.Thread(target=dispatch.run)
    thread.start()
    try:
        yield dispatch
    finally:
        dispatch.stop()
        thread.join(GUARD_S)
        assert not thread.is_alive()


def test_a_leader_does_its_duties_again_and_again_whatever_goes_wrong_in_them(database: Database) -> None:
    known, unforeseen, sound = Counter(QueueUnavailableError("away")), Counter(ValueError("bug")), Counter()
    tasks = [PeriodicTask(str(number), 0.01, work) for number, work in enumerate((known, unforeseen, sound))]
    with running(database, "a", *tasks):
        assert all(counter.enough.wait(GUARD_S) for counter in (known, unforeseen, sound))


def test_a_slow_duty_holds_up_no_other(database: Database) -> None:
    goes_on, quick = threading.Event(), Counter()

    def slow(is_over: Callable[[], bool]) -> str:
        goes_on.wait(GUARD_S)
        return ""

    with running(database, "a", PeriodicTask("slow", 0.01, slow), PeriodicTask("quick", 0.01, quick)):
        assert quick.enough.wait(GUARD_S)
        goes_on.set()


def test_one_that_stands_by_does_nothing_until_the_leader_is_gone(database: Database) -> None:
    first, second = Counter(), Counter()
    with running(database, "a", PeriodicTask("x", 0.01, first)):
        assert first.enough.wait(GUARD_S)
        with running(database, "b", PeriodicTask("x", 0.01, second)) as waiting:
            turns = first.turns
            first.enough.clear()
            assert first.enough.wait(GUARD_S)
            assert first.turns > turns
            assert second.turns == 0
            assert waiting is not None
    with running(database, "b", PeriodicTask("x", 0.01, second)):
        assert second.enough.wait(GUARD_S)


def test_a_dispatcher_that_stops_lets_another_lead_at_once(database: Database) -> None:
    with running(database, "a", PeriodicTask("x", 0.01, work := Counter())):
        assert work.enough.wait(GUARD_S)
    assert current_leader(database, NAME) is None


def test_a_duty_is_told_to_break_off_when_the_dispatcher_stops(database: Database) -> None:
    began, broke_off = threading.Event(), threading.Event()

    def long(is_over: Callable[[], bool]) -> str:
        began.set()
        while not is_over():
            threading.Event().wait(0.01)
        broke_off.set()
        return ""

    with running(database, "a", PeriodicTask("long", 0.01, long)) as dispatch:
        assert began.wait(GUARD_S)
        dispatch.stop()
        assert broke_off.wait(GUARD_S)
