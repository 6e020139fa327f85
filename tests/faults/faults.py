"""The faults: each strikes once, waits until it shows, and says what showed it.

`kills` take single processes; `outages` take what all of them stand on. Both go on at the same time.
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
from tests.faults.load import Station
from tests.faults.probes import Probe
from tests.faults.strikes import Record, Strike, Victim, leader_holder, leader_name, victims
from tests.waiting import GUARD_S

_LOOK_S = 0.1
_VICTIM_TIMEOUT_S = 20.0


@dataclass(frozen=True)
class Field:
    """Where faults strike.

    Attributes
    ----------
    cluster, backend, database : Cluster, Backend, Database
    station : Station
        Of a client that cancels jobs of dead workers.
    probe : Probe
        Asks the service for one thing, without patience.
    record : Record
    lease_s : float
    rng : random.Random
    """

    cluster: Cluster
    backend: Backend
    database: Database
    station: Station
    probe: Probe
    record: Record
    lease_s: float
    rng: random.Random


Fault = Callable[[Field], Strike | None]


def kill_api(field: Field) -> Strike:
    """SIGKILL an API."""
    name = field.rng.choice(APIS)
    return _killed(field, "API killed", name)


def kill_dispatcher(field: Field) -> Strike | None:
    """SIGKILL the leading dispatcher; another one has to lead."""
    holder, name = leader_holder(field.database), leader_name(field.database, field.cluster)
    if name not in DISPATCHERS:
        return None
    strike = _killed(field, "leading dispatcher killed", name)
    _wait(lambda: leader_holder(field.database) not in (holder, None), "nobody else leads")
    return Strike(strike.fault, strike.at, f"{strike.evidence}, another one leads")


def kill_worker(field: Field) -> Strike | None:
    """SIGKILL a worker in the middle of a job; sometimes its job is canceled at once."""
    victim = _find_victim(field)
    if victim is None:
        return None
    strike = _killed(field, "worker killed", victim.worker, victim)
    if field.rng.random() < 0.3:
        field.station.cancel(victim.job_id, "dead worker", victim.stage)
    return strike


def kill_fork_server(field: Field) -> Strike | None:
    """SIGKILL the process that a worker's engines are forked from, idle or with an engine at work."""
    victim = _find_victim(field) if field.rng.random() < 0.7 else None
    worker = victim.worker if victim else field.rng.choice(WORKERS)
    fork_server = next((child for child in field.cluster.children(worker) if _is_fork_server(child)), None)
    # One that was picked by chance has to be idle: at work it might be at the last attempt that a job has.
    if fork_server is None or (victim is None and _children(fork_server)):
        return None
    return _killed_child("fork server killed", fork_server, victim)


def kill_engine(field: Field) -> Strike | None:
    """SIGKILL an engine at work."""
    victim = _find_victim(field)
    below = field.cluster.children(victim.worker) if victim else []
    engines = [child for fork_server in below if _is_fork_server(fork_server) for child in _children(fork_server)]
    return _killed_child("engine killed", engines[0], victim) if engines else None


def drain_worker(field: Field) -> Strike | None:
    """SIGTERM a worker in the middle of a job."""
    victim = _find_victim(field)
    if victim is None:
        return None
    at = utc_now()
    pid = field.cluster.kill(victim.worker, signal.SIGTERM)
    death = field.cluster.wait_for_death(pid)
    return Strike("worker drained", at, f"process {pid} ended with {death.returncode}", victim)


def freeze_worker(field: Field) -> Strike | None:
    """Stop a worker for longer than its lease; it wakes up as the late twin of its successor."""
    victim = _find_victim(field)
    pid = field.cluster.pid(victim.worker) if victim else None
    if victim is None or pid is None:
        return None
    at = utc_now()
    try:
        process = psutil.Process(pid)
        process.suspend()
        time.sleep(field.lease_s + 3.0)
        is_stopped = process.status() == psutil.STATUS_STOPPED
        process.resume()
    except psutil.NoSuchProcess:
        return None  # a kill struck it in its sleep
    return Strike("worker frozen", at, f"process {pid} stopped: {is_stopped}, for {field.lease_s + 3:g} s", victim)


def kill_valkey(field: Field) -> Strike:
    """SIGKILL the queue's server; it comes back after some seconds."""
    at = utc_now()
    pid = field.cluster.kill(VALKEY, away_s=field.rng.uniform(0.5, 4.0))
    death = field.cluster.wait_for_death(pid)
    _wait(lambda: field.cluster.pid(VALKEY) is not None, "Valkey is not back")
    return Strike("Valkey killed", at, f"process {pid} ended with {death.returncode}")


def flush_valkey(field: Field) -> Strike | None:
    """Empty the queue's server."""
    with field.backend.redis() as redis:
        transaction = redis.pipeline(transaction=True)
        at = utc_now()
        before, _, after = transaction.dbsize().flushall().dbsize().execute()
    return Strike("Valkey flushed", at, f"{before} keys before, {after} after") if before else None


def stop_database(field: Field) -> Strike:
    """Take the database away for some seconds."""
    at = utc_now()
    return Strike("database away", at, field.backend.database.take_away(field.rng.uniform(1.0, 4.0)))


def refuse_store(field: Field) -> Strike:
    """Let the store refuse writes for some seconds."""
    at = utc_now()
    field.backend.store_server.refuse()
    try:
        answer = field.probe.wait_for_refusal()
        time.sleep(field.rng.uniform(2.0, 6.0))
    finally:
        field.backend.store_server.accept()
    return Strike("store refuses", at, f"an upload got {answer}")


def fill_disk(field: Field) -> Strike:
    """Leave no room on a disk for some seconds."""
    disk = field.rng.choice(field.backend.full)
    return _filled(field, disk)


def cut_off(field: Field) -> Strike | None:
    """Take the link of a worker, an API or the leading dispatcher down, for longer than its lease."""
    kinds = ["worker", "worker", "api"]
    if field.database.engine.dialect.name != "sqlite":
        # The lead is kept in the database: one that lies in a file can't be cut off.
        kinds.append("dispatcher")
    kind = field.rng.choice(kinds)
    victim = _find_victim(field) if kind == "worker" else None
    name = {
        "worker": victim.worker if victim else None,
        "api": field.rng.choice(APIS),
        "dispatcher": leader_name(field.database, field.cluster),
    }[kind]
    if name is None:
        return None
    at = utc_now()
    field.cluster.network.cut(name)
    try:
        time.sleep(field.lease_s + 5.0)
        assert not field.cluster.network.has_link(name)
        seen = ""
        if kind == "api":
            seen = f", clients reach it: {field.probe.reaches(name)}"
        elif kind == "dispatcher":
            _wait(lambda: leader_name(field.database, field.cluster) not in (name, None), "nobody else leads")
            seen = ", another one leads"
    finally:
        field.cluster.network.heal(name)
    return Strike(f"{kind} cut off", at, f"{name} had no link for {field.lease_s + 5:g} s{seen}", victim)


KILLS: Sequence[Fault] = (kill_worker, kill_engine, kill_fork_server, kill_api, kill_dispatcher, drain_worker)
OUTAGES: Sequence[Fault] = (kill_valkey, flush_valkey, stop_database, refuse_store, fill_disk, freeze_worker)


def _killed(field: Field, fault: str, name: str, victim: Victim | None = None) -> Strike:
    at = utc_now()
    pid = field.cluster.kill(name)
    death = field.cluster.wait_for_death(pid)
    return Strike(fault, at, f"process {pid} ended with {death.returncode}", victim)


def _killed_child(fault: str, process: psutil.Process, victim: Victim | None) -> Strike | None:
    at = utc_now()
    try:
        process.kill()
    except psutil.NoSuchProcess:
        return None
    _wait(lambda: not _is_alive(process), f"process {process.pid} lives on")
    return Strike(fault, at, f"process {process.pid} is gone", victim)


def _filled(field: Field, disk: Disk) -> Strike:
    at = utc_now()
    try:
        disk.fill()
        answer = field.probe.wait_for_refusal()
        time.sleep(field.rng.uniform(2.0, 6.0))
    finally:
        disk.empty()
    return Strike("disk full", at, f"no byte free on {disk.folder.name}, an upload got {answer}")


def _find_victim(field: Field) -> Victim | None:
    """Find an attempt at work, better one that has got somewhere."""
    deadline = time.monotonic() + _VICTIM_TIMEOUT_S
    while time.monotonic() < deadline:
        try:
            found = victims(field.database, field.cluster)
        except JobkitError:
            found = []  # the database is away just now
        if found:
            return field.rng.choice([victim for victim in found if victim.stage] or found)
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
        return [child for child in process.children() if _is_alive(child)]
    except psutil.NoSuchProcess:
        return []


def _is_alive(process: psutil.Process) -> bool:
    try:
        return bool(process.is_running() and process.status() != psutil.STATUS_ZOMBIE)
    except psutil.NoSuchProcess:
        return False


def _wait(condition: Callable[[], object], words: str) -> None:
    deadline = time.monotonic() + GUARD_S
    while True:
        try:
            if condition():
                return
        except JobkitError:
            pass  # the database is away just now
        assert time.monotonic() < deadline, words
        time.sleep(_LOOK_S)
