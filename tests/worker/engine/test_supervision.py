"""Also tests `worker.engine.entry`."""

import contextlib
import json
import os
import signal
import threading
from pathlib import Path

import psutil
import pytest

from quadpatch.processes import LEAST_BYTES
from tests.waiting import GUARD_S, wait_until
from worker.engine.client import ForkServer
from worker.engine.limits import EngineLimits
from worker.engine.request import EngineRequest
from worker.engine.supervision import Observer, run_engine
from worker.failures import EngineFailedError, EngineStoppedError, Failure, StopReason

LIMITS = EngineLimits(time_s=GUARD_S, memory_mb=1024, n_threads=1)


def never() -> StopReason | None:
    return None


def request(behaviour: str, limits: EngineLimits = LIMITS) -> EngineRequest:
    return EngineRequest(task="inspect", source="source.ply", limits=limits, options={"behaviour": behaviour})


def failure_of(fork_server: ForkServer, folder: Path, behaviour: str, limits: EngineLimits = LIMITS) -> Failure:
    with pytest.raises(EngineFailedError) as caught:
        run_engine(fork_server, request(behaviour, limits), folder, Observer(lambda stage, fraction: None, never))
    return caught.value.failure


def engines() -> list[psutil.Process]:
    """Children of the fork server of this process that run."""
    return [
        engine
        for fork_server in psutil.Process().children()
        if "worker.engine.fork_server" in fork_server.cmdline()
        for engine in fork_server.children(recursive=True)
        if engine.status() != psutil.STATUS_ZOMBIE
    ]


def of_two_processes(folder: Path, behaviour: str, memory_mb: int = 1024) -> EngineRequest:
    """Ask for a repair whose second process misbehaves; its file is large enough for two."""
    (folder / "source.ply").write_bytes(bytes(LEAST_BYTES))
    limits = EngineLimits(time_s=GUARD_S, memory_mb=memory_mb, file_mb=4, n_threads=1, n_processes=2)
    return EngineRequest("repair", "source.ply", limits, options={"behaviour": behaviour, "in_helper": True})


def helper_of(folder: Path) -> int:
    """Wait until the second process of a repair is at work, and give its id."""
    wait_until(lambda: (folder / "helper").exists() and (folder / "helper").read_text() != "")
    return int((folder / "helper").read_text())


def has_ended(pid: int) -> bool:
    return not psutil.pid_exists(pid) or psutil.Process(pid).status() == psutil.STATUS_ZOMBIE


def test_an_engine_works_in_its_folder_and_reports_progress(rogue_fork_server: ForkServer, tmp_path: Path) -> None:
    seen: list[tuple[str, float]] = []
    observer = Observer(lambda stage, fraction: seen.append((stage, fraction)), never)
    run_engine(rogue_fork_server, request("behave"), tmp_path, observer)
    assert seen == [("fill", 0.5)]
    assert json.loads((tmp_path / "facts.json").read_text())["cwd"] == str(tmp_path)
    assert "this goes to the log" in (tmp_path / "engine.log").read_text()
    assert engines() == []


def test_an_engine_is_told_no_secret_of_its_worker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[1]))
    secrets = ("QUADPATCH_DATABASE_URL", "QUADPATCH_API_KEYS", "AWS_SECRET_ACCESS_KEY", "PGPASSWORD", "UNHEARD_OF")
    for name in (*secrets, "MALLOC_ARENA_MAX"):
        monkeypatch.setenv(name, "2")
    with ForkServer(n_threads=1, engine="rogue_engine") as fork_server:
        run_engine(fork_server, request("behave"), tmp_path, Observer(lambda stage, fraction: None, never))
    names = json.loads((tmp_path / "facts.json").read_text())["names"]
    assert "MALLOC_ARENA_MAX" in names
    assert set(names) & set(secrets) == set()


def test_every_request_gets_a_fresh_process(rogue_fork_server: ForkServer, tmp_path: Path) -> None:
    pids = set()
    for number in range(3):
        folder = tmp_path / str(number)
        folder.mkdir()
        run_engine(rogue_fork_server, request("behave"), folder, Observer(lambda stage, fraction: None, never))
        pids.add(json.loads((folder / "facts.json").read_text())["pid"])
    assert len(pids) == 3


def test_an_engine_over_its_time_is_ended(rogue_fork_server: ForkServer, tmp_path: Path) -> None:
    times = [0.0]
    limits = EngineLimits(time_s=30.0, memory_mb=1024, n_threads=1)
    # The time is up as soon as the engine is at work, however long it took to come there.
    observer = Observer(lambda stage, fraction: times.append(31.0), never)
    with pytest.raises(EngineFailedError) as caught:
        run_engine(rogue_fork_server, request("hang_in_native_code", limits), tmp_path, observer, lambda: times[-1])
    failure = caught.value.failure
    assert (failure.code, failure.stage, failure.retryable) == ("time_limit_exceeded", "fill", False)
    assert engines() == []


@pytest.mark.parametrize("behaviour", ["take_memory_for_a_moment", "hog_memory"])
def test_the_most_memory_is_known_however_short_it_was_and_however_the_engine_ends(
    rogue_fork_server: ForkServer, tmp_path: Path, behaviour: str
) -> None:
    peaks: list[float] = []
    limits = EngineLimits(time_s=GUARD_S, memory_mb=500, n_threads=1)
    observer = Observer(lambda stage, fraction: None, never, on_peak=peaks.append)
    with contextlib.suppress(EngineFailedError):
        run_engine(rogue_fork_server, request(behaviour, limits), tmp_path, observer)
    (peak_mb,) = peaks
    assert 200 < peak_mb < 1024


@pytest.mark.parametrize("behaviour", ["hog_memory", "ask_for_too_much_at_once"])
def test_an_engine_over_its_memory_is_ended(rogue_fork_server: ForkServer, tmp_path: Path, behaviour: str) -> None:
    limits = EngineLimits(time_s=GUARD_S, memory_mb=300, n_threads=1)
    failure = failure_of(rogue_fork_server, tmp_path, behaviour, limits)
    assert (failure.code, failure.retryable) == ("out_of_memory", False)
    assert engines() == []


def test_a_crash_in_native_code_costs_the_engine_only(rogue_fork_server: ForkServer, tmp_path: Path) -> None:
    failure = failure_of(rogue_fork_server, tmp_path, "crash")
    assert failure == Failure("engine_crashed", "the engine was ended by SIGSEGV", "fill", retryable=True)
    assert not list(tmp_path.glob("core*"))
    (tmp_path / "next").mkdir()
    run_engine(rogue_fork_server, request("behave"), tmp_path / "next", Observer(lambda stage, fraction: None, never))


def test_an_engine_that_leaves_silently_has_crashed(rogue_fork_server: ForkServer, tmp_path: Path) -> None:
    assert failure_of(rogue_fork_server, tmp_path, "leave_silently").message == "the engine ended without a word"


def test_a_foreseen_error_passes_through_without_the_workers_paths(
    rogue_fork_server: ForkServer, tmp_path: Path
) -> None:
    failure = failure_of(rogue_fork_server, tmp_path, "raise_an_error_with_a_path")
    assert failure == Failure("unreadable_mesh", "cannot read source.ply", "fill")


def test_the_details_of_an_unforeseen_error_stay_in_the_log(
    rogue_fork_server: ForkServer, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    failure = failure_of(rogue_fork_server, tmp_path, "raise_something_unforeseen")
    assert failure == Failure("engine_error", "unexpected internal error of the engine", "fill")
    assert "secret detail" in caplog.text


def test_an_engine_can_not_fill_the_disk(rogue_fork_server: ForkServer, tmp_path: Path) -> None:
    limits = EngineLimits(time_s=GUARD_S, memory_mb=1024, file_mb=4, n_threads=1)
    failure = failure_of(rogue_fork_server, tmp_path, "fill_the_disk", limits)
    assert failure.code == "result_too_large"
    assert (tmp_path / "huge").stat().st_size == 4 << 20


def test_an_engine_that_can_not_even_write_its_log_says_that_the_disk_is_full(
    rogue_fork_server: ForkServer, tmp_path: Path
) -> None:
    """Otherwise it would look like a crash, and three of them end a job."""
    failure = failure_of(rogue_fork_server, tmp_path, "meet_a_full_disk")
    assert (failure.code, failure.is_outside) == ("no_space", True)


@pytest.mark.parametrize(
    ("behaviour", "code"),
    [
        ("crash", "engine_crashed"),
        ("leave_silently", "engine_crashed"),
        ("hog_memory", "out_of_memory"),
        ("ask_for_too_much_at_once", "out_of_memory"),
        ("fill_the_disk", "result_too_large"),
        ("raise_something_unforeseen", "engine_error"),
        ("raise_an_error_with_a_path", "unreadable_mesh"),
    ],
)
def test_whatever_ends_an_engine_after_it_has_delivered_the_result_is_kept(
    rogue_fork_server: ForkServer, tmp_path: Path, behaviour: str, code: str
) -> None:
    limits = EngineLimits(time_s=60.0, memory_mb=300, file_mb=4, n_threads=1)
    asked = EngineRequest("inspect", "source.ply", limits, options={"behaviour": behaviour, "delivers": True})
    failure = run_engine(rogue_fork_server, asked, tmp_path, Observer(lambda stage, fraction: None, never))
    assert failure is not None
    assert (failure.code, failure.stage) == (code, "preview")
    assert (tmp_path / "repaired.ply").read_text() == "a mesh"
    assert engines() == []


def test_an_engine_that_draws_beyond_its_time_has_delivered_all_the_same(
    rogue_fork_server: ForkServer, tmp_path: Path
) -> None:
    limits = EngineLimits(time_s=1.0, memory_mb=1024, n_threads=1)
    asked = EngineRequest(
        "inspect", "source.ply", limits, options={"behaviour": "hang_in_native_code", "delivers": True}
    )
    failure = run_engine(rogue_fork_server, asked, tmp_path, Observer(lambda stage, fraction: None, never))
    assert failure is not None
    assert failure.code == "time_limit_exceeded"


def test_an_engine_that_has_delivered_still_stops_when_it_is_asked_to(
    rogue_fork_server: ForkServer, tmp_path: Path
) -> None:
    is_drawing = threading.Event()

    def note(stage: str, fraction: float) -> None:
        if stage == "preview":
            is_drawing.set()

    observer = Observer(note, lambda: StopReason.CANCELED if is_drawing.is_set() else None)
    asked = EngineRequest(
        "inspect", "source.ply", LIMITS, options={"behaviour": "hang_in_native_code", "delivers": True}
    )
    with pytest.raises(EngineStoppedError):
        run_engine(rogue_fork_server, asked, tmp_path, observer)


def test_what_an_engine_started_ends_with_it(rogue_fork_server: ForkServer, tmp_path: Path) -> None:
    folder = tmp_path / "request"
    folder.mkdir()
    run_engine(rogue_fork_server, request("start_a_grandchild"), folder, Observer(lambda stage, fraction: None, never))
    pid = int((folder / "grandchild").read_text())
    wait_until(lambda: not psutil.pid_exists(pid) or psutil.Process(pid).status() == psutil.STATUS_ZOMBIE)


@pytest.mark.parametrize("behaviour", ["hang_in_native_code", "ignore_signals_and_hang"])
@pytest.mark.parametrize("reason", list(StopReason))
def test_an_engine_is_ended_when_asked_whatever_it_does(
    rogue_fork_server: ForkServer, tmp_path: Path, behaviour: str, reason: StopReason
) -> None:
    is_at_work = threading.Event()

    def stop_reason() -> StopReason | None:
        return reason if is_at_work.is_set() else None

    observer = Observer(lambda stage, fraction: is_at_work.set(), stop_reason)
    with pytest.raises(EngineStoppedError) as caught:
        run_engine(rogue_fork_server, request(behaviour), tmp_path, observer)
    assert caught.value.reason is reason
    assert engines() == []


@pytest.mark.parametrize(
    ("behaviour", "code", "retryable"),
    [
        ("crash", "engine_crashed", True),
        ("leave_silently", "engine_crashed", True),
        ("hog_memory", "out_of_memory", False),
        ("ask_for_too_much_at_once", "out_of_memory", False),
        ("fill_the_disk", "result_too_large", False),
        ("raise_something_unforeseen", "engine_error", False),
        ("raise_an_error_with_a_path", "unreadable_mesh", False),
    ],
)
def test_what_ends_a_process_that_shares_a_repair_is_reported_as_the_engines_own(
    rogue_fork_server: ForkServer, tmp_path: Path, behaviour: str, code: str, retryable: bool
) -> None:
    asked = of_two_processes(tmp_path, behaviour, memory_mb=300)
    peaks: list[float] = []
    observer = Observer(lambda stage, fraction: None, never, on_peak=peaks.append)
    with pytest.raises(EngineFailedError) as caught:
        run_engine(rogue_fork_server, asked, tmp_path, observer)
    failure = caught.value.failure
    assert (failure.code, failure.stage, failure.retryable) == (code, "fill", retryable)
    assert behaviour != "hog_memory" or peaks[0] > 300
    wait_until(lambda: has_ended(helper_of(tmp_path)))
    assert engines() == []


def test_the_memory_of_a_process_that_shares_a_repair_counts(rogue_fork_server: ForkServer, tmp_path: Path) -> None:
    memory: list[float] = []
    peaks: list[float] = []
    observer = Observer(lambda stage, fraction: None, never, memory.append, peaks.append)
    run_engine(rogue_fork_server, of_two_processes(tmp_path, "take_memory_for_a_while"), tmp_path, observer)
    assert 200 < max(memory) < 1024
    assert 200 < peaks[0] < 1024


@pytest.mark.parametrize("victim", ["helper", "engine", "fork server"])
def test_no_process_of_a_repair_outlives_another_that_is_killed(
    rogue_fork_server: ForkServer, tmp_path: Path, victim: str
) -> None:
    def kill(stage: str, fraction: float) -> None:
        helper = psutil.Process(helper_of(tmp_path))
        engine = psutil.Process(helper.ppid())
        os.kill({"helper": helper.pid, "engine": engine.pid, "fork server": engine.ppid()}[victim], signal.SIGKILL)

    with pytest.raises(EngineFailedError) as caught:
        run_engine(
            rogue_fork_server, of_two_processes(tmp_path, "hang_in_native_code"), tmp_path, Observer(kill, never)
        )
    assert caught.value.failure.code == "engine_crashed"
    wait_until(lambda: has_ended(helper_of(tmp_path)))
    assert engines() == []


def test_all_processes_of_a_repair_are_ended_when_asked(rogue_fork_server: ForkServer, tmp_path: Path) -> None:
    def stop_reason() -> StopReason | None:
        return StopReason.CANCELED if (tmp_path / "helper").exists() else None

    with pytest.raises(EngineStoppedError):
        run_engine(
            rogue_fork_server,
            of_two_processes(tmp_path, "ignore_signals_and_hang"),
            tmp_path,
            Observer(lambda stage, fraction: None, stop_reason),
        )
    wait_until(lambda: has_ended(helper_of(tmp_path)))
    assert engines() == []


def test_an_engine_killed_from_outside_is_a_crash_that_may_be_tried_again(
    rogue_fork_server: ForkServer, tmp_path: Path
) -> None:
    def kill(stage: str, fraction: float) -> None:
        (engine,) = engines()
        os.kill(engine.pid, signal.SIGKILL)

    with pytest.raises(EngineFailedError) as caught:
        run_engine(rogue_fork_server, request("hang_in_native_code"), tmp_path, Observer(kill, never))
    assert caught.value.failure == Failure("engine_crashed", "the engine was ended by SIGKILL", "fill", retryable=True)


def test_a_killed_fork_server_takes_its_engine_along_and_is_replaced(
    rogue_fork_server: ForkServer, tmp_path: Path
) -> None:
    def kill(stage: str, fraction: float) -> None:
        (engine,) = engines()
        os.kill(engine.ppid(), signal.SIGKILL)

    with pytest.raises(EngineFailedError) as caught:
        run_engine(rogue_fork_server, request("hang_in_native_code"), tmp_path, Observer(kill, never))
    assert caught.value.failure.code == "engine_crashed"
    assert engines() == []
    (tmp_path / "next").mkdir()
    run_engine(rogue_fork_server, request("behave"), tmp_path / "next", Observer(lambda stage, fraction: None, never))
