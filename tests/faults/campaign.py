"""One campaign: a cluster under load and under faults, and the account of what it did."""

import logging
import random
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

import psutil

from jobkit.database.session import Database
from jobkit.errors import DatabaseUnavailableError
from tests.faults.backends import Backend, BackendName, open_backend
from tests.faults.cluster import APIS, WORKERS, Cluster, Setup
from tests.faults.faults import KILLS, OUTAGES, Fault, Field, cut_off
from tests.faults.ledger import Account, cancels_s, recoveries_s, take_account
from tests.faults.load import Book, Load, Plan, Station
from tests.faults.network import open_network
from tests.faults.probes import Probe
from tests.faults.strikes import Record, Strike
from tests.waiting import GUARD_S

_TRIES = 20
_LOOK_S = 0.2

_log = logging.getLogger("faults")


@dataclass(frozen=True)
class Campaign:
    """What is to be done.

    Attributes
    ----------
    plan : Plan
    backend : "sqlite-local" or "postgres-s3"
    rounds : int
        How often each outage strikes.
    pause_s : (float, float)
        Shortest and longest pause between two kills, and between two outages.
    settings : dict
        Variables for all processes; by default they run as in a deployment.
    kills, outages : sequence of Fault
        Both strike at the same time. Where there are namespaces, links go down, too.
    wants_namespaces : bool
    lease_s : float
        Of attempts.
    kills_per_outage : int
        How often each kill strikes for every time that an outage does.
    """

    plan: Plan
    backend: BackendName
    rounds: int
    pause_s: tuple[float, float] = (1.0, 5.0)
    settings: dict[str, str] = field(default_factory=dict)
    kills: Sequence[Fault] = KILLS
    outages: Sequence[Fault] = OUTAGES
    wants_namespaces: bool = True
    lease_s: float = 15.0
    kills_per_outage: int = 1


@dataclass(frozen=True)
class Outcome:
    """What came of it."""

    account: Account
    record: Record
    book: Book
    recoveries_s: dict[str, list[float]]
    cancels_s: dict[str, list[float]]
    network: str
    seconds: float
    logged: dict[str, int]


def run_campaign(campaign: Campaign, root: Path) -> Outcome:
    """Run a campaign in an empty folder."""
    began = time.monotonic()
    with ExitStack() as stack:
        network = stack.enter_context(open_network(campaign.wants_namespaces))
        backend = stack.enter_context(open_backend(campaign.backend, root, network))
        settings = {"QUADPATCH_LEASE_S": str(campaign.lease_s), **campaign.settings, **backend.environment}
        setup = Setup(root, backend.data.folder, network, settings, backend.shares_data)
        cluster = stack.enter_context(_running(Cluster(setup, backend.servers)))
        database = stack.enter_context(closing(Database(backend.database.url)))
        urls = {name: cluster.url(name) for name in APIS}
        book, record = Book(), Record()
        station = stack.enter_context(closing(Station(list(urls.values()), book)))
        field = Field(
            cluster,
            backend,
            database,
            station,
            Probe(urls),
            record,
            campaign.lease_s,
            random.Random(campaign.plan.seed),
        )
        outages = [*campaign.outages, *([cut_off] if network.can_cut else [])]
        _fight(campaign, field, list(urls.values()), book, outages)
        _wait_until_quiet(cluster, backend)
        account = take_account(database, backend.open_store(), book, cluster.data_folders(), _engines(cluster))
        recoveries, cancels = recoveries_s(database, record.strikes), cancels_s(database, book)
        logged = _logged(root / "logs", ("may write no more", "could not connect", "lead could not be"))
    return Outcome(account, record, book, recoveries, cancels, network.words, time.monotonic() - began, logged)


def _fight(campaign: Campaign, field: Field, urls: list[str], book: Book, outages: Sequence[Fault]) -> None:
    """Let stations work while two rows of faults strike, one in a thread of its own."""
    kills_over = threading.Event()
    failures: list[BaseException] = []

    def kill() -> None:
        try:
            # Each is over sooner than an outage, so there is time for more of them.
            _strike_all(campaign, field, campaign.kills, campaign.kills_per_outage)
        except BaseException as error:  # noqa: BLE001 - raised again below, in the thread that everybody sees
            failures.append(error)
        finally:
            kills_over.set()

    outages_over = threading.Event()
    load = Load(campaign.plan, urls, book, lambda: not (kills_over.is_set() and outages_over.is_set()))
    thread = threading.Thread(target=kill, name="kills")
    thread.start()
    try:
        # In this thread: the database's server is tied to the one that starts it.
        _strike_all(campaign, field, outages)
    finally:
        outages_over.set()
        thread.join()
        load.finish()
    if failures:
        raise failures[0]


def _strike_all(campaign: Campaign, field: Field, faults: Sequence[Fault], times: int = 1) -> None:
    rng = random.Random(f"{campaign.plan.seed}-{faults[0].__name__}")
    row = [fault for fault in faults for _ in range(campaign.rounds * times)]
    rng.shuffle(row)
    for fault in row:
        time.sleep(rng.uniform(*campaign.pause_s))
        strike = _strike(fault, field)
        if strike is None:
            field.record.note_missed(fault.__name__)
        else:
            field.record.note(strike)
            _log.info("%s: %s", strike.fault, strike.evidence)


def _strike(fault: Fault, field: Field) -> Strike | None:
    """Let a fault strike; where its victim, or the database, is gone at that moment it tries once more."""
    for _ in range(_TRIES):
        with suppress(DatabaseUnavailableError, psutil.NoSuchProcess):
            strike = fault(field)
            if strike is not None:
                return strike
        time.sleep(_LOOK_S)
    return None


@contextmanager
def _running(cluster: Cluster) -> Iterator[Cluster]:
    try:
        cluster.start()
        yield cluster
    finally:
        cluster.stop()


def _wait_until_quiet(cluster: Cluster, backend: Backend, timeout_s: float = GUARD_S) -> None:
    """Wait until all workers are back and idle; what is not ended or swept up by then is left over."""
    deadline = time.monotonic() + timeout_s
    while time.monotonic() < deadline:
        folders = [path for folder in cluster.data_folders() for path in folder.glob("work/*/request-*")]
        if all(cluster.is_ready(name) for name in WORKERS) and not _engines(cluster) and not folders:
            return
        time.sleep(0.2)


def _engines(cluster: Cluster) -> list[psutil.Process]:
    """Return all processes below workers that are no fork server."""
    below = [cluster.children(name) for name in WORKERS]
    return [process for children in below for process in children if process not in children[:1]]


def _logged(folder: Path, words: Sequence[str]) -> dict[str, int]:
    text = "".join(path.read_text(errors="replace") for path in sorted(folder.glob("*.log")))
    return {phrase: text.count(phrase) for phrase in words}
