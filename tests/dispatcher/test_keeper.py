import contextlib
import time

import pytest

from dispatcher.keeper import Keeper
from jobkit.errors import DatabaseUnavailableError, JobkitError, QueueUnavailableError
from jobkit.reconcile import Reconciled

HEARTBEAT_S = 0.3


class Looks:
    """What the keeper asked for, and an error for it to meet."""

    def __init__(self) -> None:
        self.took_leases: list[bool] = []
        self.error: JobkitError | None = None

    def __call__(self, takes_leases: bool) -> Reconciled:
        self.took_leases.append(takes_leases)
        if self.error is not None:
            raise self.error
        return Reconciled(0, 0, 0)


def look_for(keeper: Keeper, seconds: float) -> None:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        with contextlib.suppress(JobkitError):
            keeper.look(lambda: False)
        time.sleep(0.02)


@pytest.fixture
def looks() -> Looks:
    return Looks()


def test_a_keeper_that_starts_gives_workers_a_heartbeat(looks: Looks) -> None:
    look_for(Keeper(looks, HEARTBEAT_S), 2 * HEARTBEAT_S)
    assert looks.took_leases[0] is False
    assert looks.took_leases[-1] is True
    assert looks.took_leases == sorted(looks.took_leases)


@pytest.mark.parametrize(
    ("error", "spares"), [(DatabaseUnavailableError("away"), True), (QueueUnavailableError("away"), False)]
)
def test_leases_are_spared_after_an_outage_of_the_database_and_of_nothing_else(
    looks: Looks, error: JobkitError, spares: bool
) -> None:
    keeper = Keeper(looks, HEARTBEAT_S)
    look_for(keeper, 2 * HEARTBEAT_S)
    looks.error = error
    look_for(keeper, 2 * HEARTBEAT_S)
    looks.error = None
    looks.took_leases.clear()
    look_for(keeper, 2 * HEARTBEAT_S)
    assert looks.took_leases[0] is not spares
    assert looks.took_leases[-1] is True


def test_what_was_found_is_told_in_words_and_nothing_in_none() -> None:
    found = [Reconciled(0, 0, 0), Reconciled(2, 1, 0)]
    keeper = Keeper(lambda _: found.pop(0), HEARTBEAT_S)
    assert keeper.look(lambda: False) == ""
    assert "ended=2" in keeper.look(lambda: False)
