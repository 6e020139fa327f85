from collections.abc import AsyncIterator
from typing import cast

import anyio
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from jobkit.database.session import Database
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.endings import Attempt
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.meshes import Meshes
from jobkit.storage.base import ObjectStore
from quadpatch_client.schema import JobResult, JobSpec, ResolvedModel
from service import streams
from service.problems import ProblemError
from service.streams import EventStreams
from tests.service.sse import sent_events


class Subject:
    """A job at work, and hands to move it on."""

    def __init__(self, database: Database, mesh_id: str) -> None:
        new = NewJob(JobSpec(mesh_id=mesh_id), ResolvedModel(requested="self", kind="self"), max_attempts=2)
        self.id = Jobs(database).create(new)[0].id
        self._attempts = Attempts(database)
        self._attempt: Attempt = self._attempts.start(self.id, "test", 30).attempt

    def progress(self, percent: float) -> None:
        self._attempts.report_progress(self._attempt, "fill", percent)

    def succeed(self) -> None:
        self._attempts.publish(self._attempt, JobResult(format="ply"))


@pytest.fixture
def mesh_id(database: Database, store: ObjectStore) -> str:
    with store.writer("meshes") as writer:
        writer.write(b"ply\n")
        stored = writer.commit()
    return Meshes(database).add(stored, "scan.ply", "ply")[0].id


async def numbers(opened: EventStreams, job_id: str, after: int) -> list[int]:
    """Read a stream to its end."""
    body = cast(AsyncIterator[bytes], opened.respond(job_id, after).body_iterator)
    text = b"".join([chunk async for chunk in body]).decode()
    return [event.id for event in sent_events(text.split("\n"))]


@pytest.mark.slow
@settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(n_before=st.integers(0, 4), n_during=st.integers(0, 4), known=st.lists(st.integers(0, 12), max_size=5))
def test_every_stream_gets_each_event_after_its_own_once_and_in_order(
    database: Database, mesh_id: str, n_before: int, n_during: int, known: list[int]
) -> None:
    subject = Subject(database, mesh_id)
    opened = EventStreams(database, most=10)
    found: dict[int, list[int]] = {}

    async def read(place: int, after: int) -> None:
        found[place] = await numbers(opened, subject.id, after)

    async def live() -> None:
        for step in range(n_before):
            subject.progress(step)
        async with opened.running(), anyio.create_task_group() as tasks:
            for place, after in enumerate(known):
                tasks.start_soon(read, place, after)
            for step in range(n_during):
                await anyio.sleep(0.005)
                await anyio.to_thread.run_sync(subject.progress, 50.0 + step)
            await anyio.to_thread.run_sync(subject.succeed)

    anyio.run(live)
    last = 2 + n_before + n_during + 1
    assert found == {place: list(range(after + 1, last + 1)) for place, after in enumerate(known)}


def test_a_log_longer_than_one_look_arrives_whole(
    database: Database, mesh_id: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(streams, "_MOST_EVENTS", 3)
    subject = Subject(database, mesh_id)
    for step in range(6):
        subject.progress(step)
    subject.succeed()
    opened = EventStreams(database, most=1)

    async def live() -> list[int]:
        async with opened.running():
            return await numbers(opened, subject.id, 0)

    assert anyio.run(live) == list(range(1, 10))


def test_a_silent_stream_shows_that_it_lives(database: Database, mesh_id: str) -> None:
    subject = Subject(database, mesh_id)
    opened = EventStreams(database, most=1, ping_s=0.01)

    async def live() -> bytes:
        async with opened.running():
            body = cast(AsyncIterator[bytes], opened.respond(subject.id, 2).body_iterator)
            await anext(body)
            return await anext(body)

    assert anyio.run(live) == b": ping\n\n"


def test_streams_end_when_the_service_stops_and_lose_nothing_that_they_were_handed(
    database: Database, mesh_id: str
) -> None:
    subject = Subject(database, mesh_id)
    opened = EventStreams(database, most=2)

    async def live() -> list[list[int]]:
        found: list[list[int]] = []

        async def read() -> None:
            found.append(await numbers(opened, subject.id, 0))

        async with opened.running(), anyio.create_task_group() as tasks:
            tasks.start_soon(read)
            while not any(stream.after for stream in opened._streams):
                await anyio.sleep(0.001)
            opened.close()
        found.append(await numbers(opened, subject.id, 0))
        return found

    assert anyio.run(live) == [[1, 2], []]


def test_there_are_never_more_streams_than_allowed(database: Database, mesh_id: str) -> None:
    subject = Subject(database, mesh_id)
    opened = EventStreams(database, most=1)

    async def live() -> None:
        opened.respond(subject.id, 0)
        with pytest.raises(ProblemError, match="the limit"):
            opened.respond(subject.id, 0)

    anyio.run(live)
    assert len(opened) == 1


def test_the_stream_of_a_job_that_is_removed_ends(database: Database, mesh_id: str) -> None:
    opened = EventStreams(database, most=1)

    async def live() -> list[int]:
        async with opened.running():
            return await numbers(opened, "job_" + "0" * 26, 0)

    assert anyio.run(live) == []
