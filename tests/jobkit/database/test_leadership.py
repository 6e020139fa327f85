import threading
import time
from datetime import timedelta

from sqlalchemy import select

from jobkit.database.leadership import Leadership, current_leader
from jobkit.database.session import Database
from jobkit.database.tables import LeaderRow
from tests.waiting import GUARD_S, wait_until


def candidate(database: Database, holder: str, lease_s: float = 60.0) -> Leadership:
    return Leadership(database, "dispatcher", holder, lease_s)


def let_pass(database: Database, seconds: float) -> None:
    """Make the lease as old as if time had passed since it was renewed."""
    with database.write() as session:
        row = session.scalars(select(LeaderRow)).one()
        row.until -= timedelta(seconds=seconds)


def test_the_first_one_leads_and_the_second_stands_by(database: Database) -> None:
    first, second = candidate(database, "a"), candidate(database, "b")
    assert [first.lead(), second.lead(), first.lead(), second.lead()] == [True, False, True, False]
    leader = current_leader(database, "dispatcher")
    assert leader is not None
    assert (leader.holder, leader.left_s > 50) == ("a", True)


def test_there_is_no_leader_before_the_first_candidate(database: Database) -> None:
    assert current_leader(database, "dispatcher") is None


def test_a_leader_that_resigns_is_followed_at_once(database: Database) -> None:
    first, second = candidate(database, "a"), candidate(database, "b")
    assert first.lead()
    second.resign()
    assert not second.lead()
    first.resign()
    assert current_leader(database, "dispatcher") is None
    assert second.lead()


def test_a_leader_that_falls_silent_is_followed_when_its_lease_runs_out(database: Database) -> None:
    assert candidate(database, "a", 0.2).lead()
    wait_until(candidate(database, "b", GUARD_S).lead)
    assert not candidate(database, "a").lead()


def test_different_things_have_different_leaders(database: Database) -> None:
    assert candidate(database, "a").lead()
    assert Leadership(database, "other", "b", 60).lead()


def test_of_many_that_start_at_once_one_leads(database: Database) -> None:
    barrier = threading.Barrier(8)
    leading: list[str] = []

    def stand(holder: str) -> None:
        barrier.wait()
        if candidate(database, holder).lead():
            leading.append(holder)

    threads = [threading.Thread(target=stand, args=(f"candidate-{number}",)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(leading) == 1


def test_a_handover_is_no_outage_and_a_long_vacancy_is_one(database: Database) -> None:
    """The leader after an outage of the database notices the outage, whether it led before or not."""
    lease_s = 10 * GUARD_S
    same, other = candidate(database, "a", lease_s), candidate(database, "b", lease_s)
    assert same.lead()
    let_pass(database, 1.1 * lease_s)
    assert same.lead()
    assert same.found_leaderless_at == float("-inf")
    for late in (same, other):
        let_pass(database, 2 * lease_s)
        before = time.monotonic()
        assert late.lead()
        assert late.found_leaderless_at >= before
