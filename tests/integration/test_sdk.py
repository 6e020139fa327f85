"""The SDK against a real local stack; examples of its docstrings run as they stand.

Also tests `quadpatch_client.async_sdk` and `quadpatch_client.handles`.
"""

import asyncio
import doctest
import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from quadpatch_client import async_sdk, handles, sdk
from quadpatch_client.async_sdk import AsyncClient
from quadpatch_client.errors import JobCanceledError, RefusedError, UnreachableError
from quadpatch_client.schema import JobState
from quadpatch_client.sdk import Client

SMOOTH = {"method": "smooth"}
EXAMPLES = [
    test for module in (sdk, handles, async_sdk) for test in doctest.DocTestFinder().find(module) if test.examples
]


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.name)
def test_examples_of_docstrings_run_as_they_stand(
    example: doctest.DocTest,
    local_stack: Any,
    relief_file: Callable[[str], Path],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    relief_file("float.ply").rename(tmp_path / "scan.ply")
    monkeypatch.chdir(tmp_path)
    example.globs |= {"URL": local_stack.url, "Path": Path, "Client": Client, "AsyncClient": AsyncClient}
    told: list[str] = []
    assert doctest.DocTestRunner().run(example, out=told.append).failed == 0, "".join(told)


def test_a_handle_follows_its_job_to_files(
    local_stack: Any, relief_file: Callable[[str], Path], tmp_path: Path
) -> None:
    seen = []
    with Client(local_stack.url) as client:
        job = client.repair(relief_file("double.ply"), method=SMOOTH, output={"preview": True, "html_report": True})
        ended = job.wait(lambda seen_job: seen.append(seen_job.state))
        assert client.repair(relief_file("double.ply"), method=SMOOTH, output=ended.spec.output).id == job.id
        assert client.handle(job.id).job.state == job.job.state == JobState.SUCCEEDED
        wanted = {"report": tmp_path / "r.json", "html": tmp_path / "r.html", "preview": tmp_path / "p.png"}
        written = job.fetch(tmp_path / "out.ply", **wanted)
    assert seen[-1] == JobState.SUCCEEDED
    assert ended.spec.label == "double.ply"
    assert all(path.stat().st_size > 0 for path in written)
    assert len(written) == 4


def test_many_scans_are_repaired_at_once_on_asyncio(
    local_stack: Any, relief_file: Callable[[str], Path], tmp_path: Path
) -> None:
    names = ("float.ply", "double.ply", "binary.stl")

    async def repaired(client: AsyncClient, name: str) -> tuple[str, JobState]:
        job = await client.repair(relief_file(name), method=SMOOTH)
        await job.fetch(tmp_path / f"out_{name}")
        return job.id, (await client.job(job.id)).state

    async def all_repaired() -> list[tuple[str, JobState]]:
        async with AsyncClient(local_stack.url, n_threads=4) as client:
            return await asyncio.gather(*(repaired(client, name) for name in names))

    done = asyncio.run(all_repaired())
    assert len({job for job, _ in done}) == 3
    assert {state for _, state in done} == {JobState.SUCCEEDED}
    assert all((tmp_path / f"out_{name}").stat().st_size > 0 for name in names)


def test_a_wait_that_is_canceled_leaves_the_event_loop_free(
    local_stack: Any, large_relief: Path, tmp_path: Path
) -> None:
    async def give_up() -> JobState:
        async with AsyncClient(local_stack.url) as client:
            job = await client.repair(large_relief, seed=77, method={"method": "dictionary", "model": "self"})
            waiting = asyncio.create_task(job.wait())
            await asyncio.sleep(0)
            waiting.cancel()
            with pytest.raises(asyncio.CancelledError):
                await waiting
            await job.cancel()
            with pytest.raises(JobCanceledError):
                await job.wait()
            return job.job.state

    assert asyncio.run(give_up()) in (JobState.CANCELING, JobState.CANCELED)


def test_errors_are_the_same_in_both() -> None:
    async def away() -> None:
        async with AsyncClient("http://127.0.0.1:9", patience_s=0.0) as client:
            await client.models()

    with pytest.raises(UnreachableError):
        asyncio.run(away())


def test_an_unknown_job_is_refused(local_stack: Any) -> None:
    with Client(local_stack.url) as client, pytest.raises(RefusedError) as caught:
        client.handle("job_" + "0" * 26)
    assert caught.value.problem.code == "job_not_found"


def test_both_clients_have_the_same_calls() -> None:
    def calls(kind: type) -> dict[str, list[str]]:
        members = inspect.getmembers(kind, inspect.isfunction)
        return {n: list(inspect.signature(f).parameters) for n, f in members if not n.startswith("_")}

    one, other = calls(Client), calls(AsyncClient)
    # To keep jobs and to unpack pictures is left to the command line.
    assert one.keys() - other.keys() == {"pin", "download_closeups"}
    assert {name: one[name] for name in other} == other
