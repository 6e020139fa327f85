"""Also tests `quadpatch_client.rejected_files`."""

import os
import re
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import wait
from pathlib import Path
from typing import Any

import pytest

from quadpatch_client.errors import AnswerError, ClientError, JobFailedError, RefusedError, UnreachableError
from quadpatch_client.file_repair import FilePlan, JobOptions, Row
from quadpatch_client.folder_watch import STATE, FolderWatch
from quadpatch_client.journal import Journal
from quadpatch_client.rejected_files import set_aside
from quadpatch_client.schema import Job, Problem
from quadpatch_client.sdk import Client
from tests.quadpatch_client.wire_jobs import body
from tests.waiting import GUARD_S, wait_until


class Refusing(Client):
    """A client whose service is away, or refuses what it gets; notes what was sent."""

    def __init__(self, *errors: ClientError) -> None:
        super().__init__("http://127.0.0.1:9")
        self.errors, self.sent = list(errors), list[tuple[str, int]]()

    def upload(self, path: Path, *_: Any) -> Any:
        self.sent.append((path.name, path.stat().st_size))
        raise self.errors.pop(0) if len(self.errors) > 1 else self.errors[0]


class Watched:
    """A watch of a folder, by a clock that is set by hand."""

    def __init__(self, folder: Path, client: Client) -> None:
        self.now, self.told = 0.0, list[str]()
        (folder / STATE).mkdir(exist_ok=True)
        self.journal = Journal(folder / STATE / "journal")
        self.watch = FolderWatch(
            client, folder, JobOptions(), self.journal, 1, 2.0, self.told.append, clock=lambda: self.now
        )

    def at(self, now: float) -> None:
        """Look at a time, and once more when what was begun has ended."""
        self.now = now
        self.watch.look()
        wait_until(lambda: all(future.done() for future in self.watch._busy.values()))
        self.watch.look()


@pytest.fixture
def watched(tmp_path: Path) -> Iterator[Callable[..., Watched]]:
    made = []

    def make(*errors: ClientError) -> Watched:
        client = Refusing(*errors)
        made.append((client, Watched(tmp_path, client)))
        made[-1][1].client = client  # type: ignore[attr-defined]
        return made[-1][1]

    yield make
    for client, watch in made:
        client.close()
        watch.journal.close()


def problem(status: int, code: str) -> RefusedError:
    return RefusedError(Problem(type="x", title="x", status=status, code=code, detail="words", instance="x"))


def failed(retryable: bool) -> JobFailedError:
    error = {"code": "worker_lost", "message": "words", "retryable": retryable}
    return JobFailedError(Job.model_validate_json(body("failed", 2, error=error)))


def test_a_file_is_taken_once_it_has_not_changed_for_a_while(tmp_path: Path, watched: Callable[..., Any]) -> None:
    watch = watched(UnreachableError("away"))
    (tmp_path / "a.ply").write_bytes(b"1")
    watch.at(0.0)
    (tmp_path / "a.ply").write_bytes(b"12")
    watch.at(1.9)
    watch.at(3.8)
    assert watch.client.sent == []
    watch.at(3.9)
    assert watch.client.sent == [("a.ply", 2)]


def test_hidden_files_results_and_others_are_left_alone(tmp_path: Path, watched: Callable[..., Any]) -> None:
    watch = watched(UnreachableError("away"))
    for name in (".a.ply", "a-repaired.ply", "notes.txt"):
        (tmp_path / name).write_bytes(b"1")
    watch.at(0.0)
    assert watch.watch.is_idle


@pytest.mark.parametrize(
    "error",
    [UnreachableError("away"), AnswerError("a page"), problem(503, "queue_unavailable"), problem(401, "unauthorized")],
)
def test_what_does_not_lie_with_the_file_is_waited_for_longer_and_longer(
    tmp_path: Path, watched: Callable[..., Any], error: ClientError
) -> None:
    watch = watched(error)
    (tmp_path / "a.ply").write_bytes(b"1")
    for now in (0.0, 2.0, 2.9, 3.0, 4.9, 5.0):
        watch.at(now)
    assert len(watch.client.sent) == 3
    assert not watch.watch.is_idle
    assert (tmp_path / "a.ply").exists()
    assert watch.told[0].startswith("a.ply waits, 1 in all: ")
    assert watch.told[-1].endswith("next try in 4 s")


@pytest.mark.parametrize(
    ("error", "n_tries"), [(problem(413, "body_too_large"), 1), (failed(False), 1), (failed(True), 3)]
)
def test_what_lies_with_the_file_sets_it_aside(
    tmp_path: Path, watched: Callable[..., Any], error: ClientError, n_tries: int
) -> None:
    watch = watched(error)
    (tmp_path / "a.ply").write_bytes(b"1")
    for now in (0.0, 10.0, 100.0, 1000.0):
        watch.at(now)
    assert len(watch.client.sent) == n_tries
    assert watch.watch.is_idle
    assert (tmp_path / "failed" / "a.ply").read_bytes() == b"1"
    assert f"why: {error}" in (tmp_path / "failed" / "a.ply.reason.txt").read_text()


def test_a_file_that_is_taken_away_is_forgotten(tmp_path: Path, watched: Callable[..., Any]) -> None:
    watch = watched(UnreachableError("away"))
    (tmp_path / "a.ply").write_bytes(b"1")
    watch.at(0.0)
    (tmp_path / "a.ply").unlink()
    watch.at(2.0)
    assert watch.watch.is_idle
    assert watch.client.sent == []


def test_no_file_that_was_set_aside_is_overwritten(tmp_path: Path) -> None:
    for content in (b"1", b"2"):
        (tmp_path / "a.ply").write_bytes(content)
        set_aside(tmp_path / "a.ply", tmp_path / "failed", Row("a.ply", "failed", job="job_1", reason="words"))
    found = {path.name: path.read_bytes() for path in (tmp_path / "failed").glob("*.ply")}
    assert found == {"a.ply": b"1", "a-2.ply": b"2"}
    assert "job: job_1" in (tmp_path / "failed" / "a-2.ply.reason.txt").read_text()
    assert os.listdir(tmp_path) == ["failed"]


def test_a_file_that_is_no_mesh_by_its_name_is_told_once(tmp_path: Path, watched: Callable[..., Any]) -> None:
    watch = watched(UnreachableError("away"))
    for name in ("notes.txt", ".hidden.ply", "a-repaired.json", ".a.ply.x.part"):
        (tmp_path / name).write_bytes(b"1")
    watch.at(0.0)
    assert watch.told == []
    # A station writes under another name, and renames.
    (tmp_path / "scan.ply.tmp").write_bytes(b"1")
    watch.at(1.0)
    (tmp_path / "scan.ply.tmp").rename(tmp_path / "-repaired.ply")
    for now in (2.0, 4.0, 8.0):
        watch.at(now)
    (said,) = [line for line in watch.told if "passed over" in line]
    assert ".hidden.ply (hidden: the name begins with a dot)" in said
    assert "notes.txt" in said
    assert not re.search(r"tmp|repaired|part", said)


def test_a_watch_that_is_refused_ends_after_the_files_at_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    is_waited_for, ended = threading.Event(), list[str]()

    def repair(_client: object, plan: FilePlan, *_: object) -> Row:
        if plan.name == "a.ply":
            raise problem(401, "unauthorized")
        is_waited_for.wait(GUARD_S)
        ended.append(plan.name)
        raise problem(401, "unauthorized")

    def wait_for(futures: Any) -> Any:
        is_waited_for.set()
        return wait(futures)

    monkeypatch.setattr("quadpatch_client.folder_watch.repair_file", repair)
    monkeypatch.setattr("quadpatch_client.folder_watch.wait", wait_for)
    for name in ("a.ply", "b.ply"):
        (tmp_path / name).write_bytes(b"ply")
    (tmp_path / STATE).mkdir()
    with Journal(tmp_path / STATE / "journal") as journal, Client("http://127.0.0.1:9") as client:
        watch = FolderWatch(
            client, tmp_path, JobOptions(), journal, 2, 0.0, lambda _: None, is_patient=False, clock=lambda: 0.0
        )
        watch.look()
        wait_until(watch._busy[tmp_path / "a.ply"].done)
        with pytest.raises(RefusedError):
            watch.look()
        assert ended == ["b.ply"]
