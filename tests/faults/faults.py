"""The faults: each is injected once, waits until it has an effect, and returns the evidence.

Kills end single processes; outages stop what all processes need. Both are injected at the same time.
"""

import random
import signal
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import psutil

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.errors import JobkitError
from tests.faults.backends import Backend
from tests.faults.cluster import APIS, DISPATCHERS, VALKEY, WORKERS, Cluster
from tests.faults.disks import Disk
from tests.faults.injections import Injection, InjectionLog, Target, leader_holder, leader_name, targets
from tests.faults.load import Station
from tests.faults.probes import Probe
from tests.waiting import GUARD_S

_LOOK_S = 0.1
_TARGET_TIMEOUT_S = 20.0


@dataclass(frozen=True)
class Testbed:
    """What faults are injected into, and the tools for it.

    Attributes
    ----------
    cluster, backend, database : Cluster, Backend, Database
    station : Station
        A client that cancels jobs of killed workers.
    probe : Probe
        Sends single requests without retries.
    injection_log : Record
    lease_s : float
    rng : random.Random
    """

    cluster: Cluster
    backend: Backend
    database: Database
    station: Station
    probe: Probe
    injection_log: InjectionLog
    lease_s: float
    rng: random.Random


Fault = Callable[[Testbed], Injection | None]


def kill_api(testbed: Testbed) -> Injection:
    """SIGKILL an API."""
    name = testbed.rng.choice(APIS)
    return _kill_process(testbed, "API killed", name)


def kill_dispatcher(testbed: Testbed) -> Injection | None:
    """SIGKILL the leading dispatcher; another one has to lead."""
    holder, name = leader_holder(testbed.database), leader_name(testbed.database, testbed.cluster)
    if name not in DISPATCHERS:
        return None
    injection = _kill_process(testbed, "leading dispatcher killed", name)
    _wait(lambda: leader_holder(testbed.database) not in (holder, None), "no other dispatcher leads")
    return Injection(injection.fault, injection.at, f"{injection.evidence}, another one leads")


def kill_worker(testbed: Testbed) -> Injection | None:
    """SIGKILL a worker in the middle of a job; sometimes its job is canceled at once."""
    target = _find_target(testbed)
    if target is None:
        return None
    injection = _kill_process(testbed, "worker killed", target.worker, target)
    if testbed.rng.random() < 0.3:
        testbed.station.cancel(target.job_id, "killed worker", target.stage)
    return injection


def kill_fork_server(testbed: Testbed) -> Injection | None:
    """SIGKILL the process that a worker's engines are forked from, idle or with an engine at work."""
    target = _find_target(testbed) if testbed.rng.random() < 0.7 else None
    worker = target.worker if target else testbed.rng.choice(WORKERS)
    fork_server = next((child for child in testbed.cluster.children(worker) if _is_fork_server(child)), None)
    # A fork server chosen at random must be idle: its engine might run the last attempt of a job.
    if fork_server is None or (target is None and _children(fork_server)):
        return None
    return _kill_child("fork server killed", fork_server, target)


def kill_engine(testbed: Testbed) -> Injection | None:
    """SIGKILL an engine at work."""
    target = _find_target(testbed)
    below = testbed.cluster.children(target.worker) if target else []
    engines = [child for fork_server in below if _is_fork_server(fork_server) for child in _children(fork_server)]
    return _kill_child("engine killed", engines[0], target) if engines else None


def drain_worker(testbed: Testbed) -> Injection | None:
    """SIGTERM a worker in the middle of a job."""
    target = _find_target(testbed)
    if target is None:
        return None
    at = utc_now()
    pid = testbed.cluster.kill(target.worker, signal.SIGTERM)
    process_end = testbed.cluster.wait_for_end(pid)
    return Injection("worker drained", at, f"process {pid} ended with {process_end.returncode}", target)


def freeze_worker(testbed: Testbed) -> Injection | None:
    """Stop a worker for longer than its lease; afterwards its attempt goes on beside the next one."""
    target = _find_target(testbed)
    pid = testbed.cluster.pid(target.worker) if target else None
    if target is None or pid is None:
        return None
    at = utc_now()
    try:
        process = psutil.Process(pid)
        process.suspend()
        time.sleep(testbed.lease_s + 3.0)
        is_stopped = process.status() == psutil.STATUS_STOPPED
        process.resume()
    except psutil.NoSuchProcess:
        return None  # it was killed while it was stopped
    return Injection("worker frozen", at, f"process {pid} stopped: {is_stopped}, for {testbed.lease_s + 3:g} s", target)


def kill_valkey(testbed: Testbed) -> Injection:
    """SIGKILL the queue's server; it comes back after some seconds."""
    at = utc_now()
    pid = testbed.cluster.kill(VALKEY, restart_delay_s=testbed.rng.uniform(0.5, 4.0))
    process_end = testbed.cluster.wait_for_end(pid)
    _wait(lambda: testbed.cluster.pid(VALKEY) is not None, "Valkey is not back")
    return Injection("Valkey killed", at, f"process {pid} ended with {process_end.returncode}")


def flush_valkey(testbed: Testbed) -> Injection | None:
    """Empty the queue's server."""
    with testbed.backend.redis() as redis:
        transaction = redis.pipeline(transaction=True)
        at = utc_now()
        before, _, after = transaction.dbsize().flushall().dbsize().execute()
    return Injection("Valkey flushed", at, f"{before} keys before, {after} after") if before else None


def stop_database(testbed: Testbed) -> Injection:
    """Make the database unavailable for some seconds."""
    at = utc_now()
    return Injection("database away", at, testbed.backend.database.make_unavailable(testbed.rng.uniform(1.0, 4.0)))


def refuse_store(testbed: Testbed) -> Injection:
    """Let the store refuse writes for some seconds."""
    at = utc_now()
    testbed.backend.store_server.refuse_writes()
    try:
        answer = testbed.probe.wait_for_refusal()
        time.sleep(testbed.rng.uniform(2.0, 6.0))
    finally:
        testbed.backend.store_server.accept_writes()
    return Injection("store refuses", at, f"an upload got {answer}")


def fill_disk(testbed: Testbed) -> Injection:
    """Fill a disk up for some seconds."""
    disk = testbed.rng.choice(testbed.backend.fillable_disks)
    return _fill_disk(testbed, disk)


def cut_off(testbed: Testbed) -> Injection | None:
    """Take the link of a worker, an API or the leading dispatcher down, for longer than its lease."""
    kinds = ["worker", "worker", "api"]
    if testbed.database.engine.dialect.name != "sqlite":
        # The row of the leader is in the database: a dispatcher can't be cut off from a file.
        kinds.append("dispatcher")
    kind = testbed.rng.choice(kinds)
    target = _find_target(testbed) if kind == "worker" else None
    name = {
        "worker": target.worker if target else None,
        "api": testbed.rng.choice(APIS),
        "dispatcher": leader_name(testbed.database, testbed.cluster),
    }[kind]
    if name is None:
        return None
    at = utc_now()
    testbed.cluster.network.cut(name)
    try:
        time.sleep(testbed.lease_s + 5.0)
        assert not testbed.cluster.network.has_link(name)
        effect = ""
        if kind == "api":
            effect = f", clients reach it: {testbed.probe.reaches(name)}"
        elif kind == "dispatcher":
            _wait(
                lambda: leader_name(testbed.database, testbed.cluster) not in (name, None), "no other dispatcher leads"
            )
            effect = ", another one leads"
    finally:
        testbed.cluster.network.restore(name)
    return Injection(f"{kind} cut off", at, f"{name} had no link for {testbed.lease_s + 5:g} s{effect}", target)


KILLS: Sequence[Fault] = (kill_worker, kill_engine, kill_fork_server, kill_api, kill_dispatcher, drain_worker)
OUTAGES: Sequence[Fault] = (kill_valkey, flush_valkey, stop_database, refuse_store, fill_disk, freeze_worker)


def _kill_process(testbed: Testbed, fault: str, name: str, target: Target | None = None) -> Injection:
    at = utc_now()
    pid = testbed.cluster.kill(name)
    process_end = testbed.cluster.wait_for_end(pid)
    return Injection(fault, at, f"process {pid} ended with {process_end.returncode}", target)


def _kill_child(fault: str, process: psutil.Process, target: Target | None) -> Injection | None:
    at = utc_now()
    try:
        process.kill()
    except psutil.NoSuchProcess:
        return None
    _wait(lambda: not _is_running(process), f"process {process.pid} still runs")
    return Injection(fault, at, f"process {process.pid} has ended", target)


def _fill_disk(testbed: Testbed, disk: Disk) -> Injection:
    at = utc_now()
    try:
        disk.fill()
        answer = testbed.probe.wait_for_refusal()
        time.sleep(testbed.rng.uniform(2.0, 6.0))
    finally:
        disk.empty()
    return Injection("disk full", at, f"no byte free on {disk.folder.name}, an upload got {answer}")


def _find_target(testbed: Testbed) -> Target | None:
    """Find a running attempt, preferably one with a stage."""
    deadline = time.monotonic() + _TARGET_TIMEOUT_S
    while time.monotonic() < deadline:
        try:
            candidates = targets(testbed.database, testbed.cluster)
        except JobkitError:
            candidates = []  # the database is unavailable at this moment
        if candidates:
            return testbed.rng.choice([target for target in candidates if target.stage] or candidates)
        time.sleep(_LOOK_S)
    return None


def _is_fork_server(process: psutil.Process) -> bool:
    try:
        # An engine is a fork of its fork server, and shows the same command line.
        return "worker.engine.fork_server" in process.cmdline() and "worker.engine.fork_server" not in _cmdline(
            process.parent()
        )
    except psutil.Error:
        return False


def _cmdline(process: psutil.Process | None) -> list[str]:
    return [] if process is None else process.cmdline()


def _children(process: psutil.Process) -> list[psutil.Process]:
    try:
        return [child for child in process.children() if _is_running(child)]
    except psutil.NoSuchProcess:
        return []


def _is_running(process: psutil.Process) -> bool:
    try:
        return bool(process.is_running() and process.status() != psutil.STATUS_ZOMBIE)
    except psutil.NoSuchProcess:
        return False


def _wait(condition: Callable[[], object], message: str) -> None:
    deadline = time.monotonic() + GUARD_S
    while True:
        try:
            if condition():
                return
        except JobkitError:
            pass  # the database is unavailable at this moment
        assert time.monotonic() < deadline, message
        time.sleep(_LOOK_S)
