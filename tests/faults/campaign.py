"""One campaign: a cluster under load and under faults, and the check of what it left."""

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
from tests.faults.consistency import ConsistencyReport, cancels_s, check_consistency, recoveries_s
from tests.faults.faults import KILLS, OUTAGES, Fault, Testbed, cut_off
from tests.faults.injections import Injection, InjectionLog
from tests.faults.load import ExpectedState, Load, Station, Workload
from tests.faults.network import open_network
from tests.faults.probes import Probe
from tests.waiting import GUARD_S

_TRIES = 20
_LOOK_S = 0.2

_log = logging.getLogger("faults")


@dataclass(frozen=True)
class Campaign:
    """How long and with what a cluster is tested.

    Attributes
    ----------
    workload : Workload
    backend : "sqlite-local" or "postgres-s3"
    rounds : int
        How often each outage is injected.
    pause_s : (float, float)
        Shortest and longest pause between two kills, and between two outages.
    settings : dict
        Variables for all processes; by default they run as in a deployment.
    kills, outages : sequence of Fault
        Both are injected at the same time. Where there are namespaces, links go down, too.
    wants_namespaces : bool
    lease_s : float
        Of attempts.
    kills_per_outage : int
        How often each kill is injected for each outage.
    """

    workload: Workload
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
    """The result of a campaign."""

    consistency: ConsistencyReport
    injection_log: InjectionLog
    expected: ExpectedState
    recoveries_s: dict[str, list[float]]
    cancels_s: dict[str, list[float]]
    network: str
    seconds: float
    phrase_counts: dict[str, int]


def run_campaign(campaign: Campaign, root: Path) -> Outcome:
    """Run a campaign in an empty folder."""
    started = time.monotonic()
    with ExitStack() as stack:
        network = stack.enter_context(open_network(campaign.wants_namespaces))
        backend = stack.enter_context(open_backend(campaign.backend, root, network))
        settings = {"QUADPATCH_LEASE_S": str(campaign.lease_s), **campaign.settings, **backend.environment}
        setup = Setup(root, backend.data.folder, network, settings, backend.shares_data)
        cluster = stack.enter_context(_running(Cluster(setup, backend.servers)))
        database = stack.enter_context(closing(Database(backend.database.url)))
        urls = {name: cluster.url(name) for name in APIS}
        expected, injection_log = ExpectedState(), InjectionLog()
        station = stack.enter_context(closing(Station(list(urls.values()), expected)))
        testbed = Testbed(
            cluster,
            backend,
            database,
            station,
            Probe(urls),
            injection_log,
            campaign.lease_s,
            random.Random(campaign.workload.seed),
        )
        outages = [*campaign.outages, *([cut_off] if network.can_cut else [])]
        _run_load_and_faults(campaign, testbed, list(urls.values()), expected, outages)
        _wait_until_idle(cluster, backend)
        consistency = check_consistency(
            database, backend.open_store(), expected, cluster.data_folders(), _engines(cluster)
        )
        recoveries, cancels = recoveries_s(database, injection_log.injections), cancels_s(database, expected)
        phrase_counts = _count_phrases(root / "logs", ("may write no more", "could not connect", "lead could not be"))
    return Outcome(
        consistency,
        injection_log,
        expected,
        recoveries,
        cancels,
        network.description,
        time.monotonic() - started,
        phrase_counts,
    )


def _run_load_and_faults(
    campaign: Campaign, testbed: Testbed, urls: list[str], expected: ExpectedState, outages: Sequence[Fault]
) -> None:
    """Let stations work while kills and outages are injected, the kills from a thread of their own."""
    kills_done = threading.Event()
    failures: list[BaseException] = []

    def kill() -> None:
        try:
            # A kill takes less time than an outage, so there are more of them.
            _inject_all(campaign, testbed, campaign.kills, campaign.kills_per_outage)
        except BaseException as error:  # noqa: BLE001 - raised again below, in the main thread
            failures.append(error)
        finally:
            kills_done.set()

    outages_done = threading.Event()
    load = Load(campaign.workload, urls, expected, lambda: not (kills_done.is_set() and outages_done.is_set()))
    thread = threading.Thread(target=kill, name="kills")
    thread.start()
    try:
        # In this thread: the server of the database ends with the thread that starts it.
        _inject_all(campaign, testbed, outages)
    finally:
        outages_done.set()
        thread.join()
        load.finish()
    if failures:
        raise failures[0]


def _inject_all(campaign: Campaign, testbed: Testbed, faults: Sequence[Fault], times: int = 1) -> None:
    rng = random.Random(f"{campaign.workload.seed}-{faults[0].__name__}")
    sequence = [fault for fault in faults for _ in range(campaign.rounds * times)]
    rng.shuffle(sequence)
    for fault in sequence:
        time.sleep(rng.uniform(*campaign.pause_s))
        injection = _inject(fault, testbed)
        if injection is None:
            testbed.injection_log.note_skipped(fault.__name__)
        else:
            testbed.injection_log.note(injection)
            _log.info("%s: %s", injection.fault, injection.evidence)


def _inject(fault: Fault, testbed: Testbed) -> Injection | None:
    """Inject a fault; where its target or the database is missing at that moment, try again."""
    for _ in range(_TRIES):
        with suppress(DatabaseUnavailableError, psutil.NoSuchProcess):
            injection = fault(testbed)
            if injection is not None:
                return injection
        time.sleep(_LOOK_S)
    return None


@contextmanager
def _running(cluster: Cluster) -> Iterator[Cluster]:
    try:
        cluster.start()
        yield cluster
    finally:
        cluster.stop()


def _wait_until_idle(cluster: Cluster, backend: Backend, timeout_s: float = GUARD_S) -> None:
    """Wait until all workers are back and idle; processes and folders that remain after that are orphans."""
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


def _count_phrases(folder: Path, phrases: Sequence[str]) -> dict[str, int]:
    text = "".join(path.read_text(errors="replace") for path in sorted(folder.glob("*.log")))
    return {phrase: text.count(phrase) for phrase in phrases}
