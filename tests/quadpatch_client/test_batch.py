"""Also tests `quadpatch_client.batch_summary`, `quadpatch_client.folder_files` and `quadpatch_client.workers`."""

import csv
import io
import re
import threading
from concurrent.futures import ALL_COMPLETED, wait
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console
from typer.testing import CliRunner

from quadpatch_client.batch import Batch
from quadpatch_client.batch_summary import print_summary, row_text, write_csv
from quadpatch_client.cli import app
from quadpatch_client.errors import MeshRejectedError, RefusedError, UsageError
from quadpatch_client.exit_codes import ExitCode
from quadpatch_client.file_repair import FilePlan, JobOptions, Row, failure
from quadpatch_client.folder_files import (
    inner_folders,
    mesh_files,
    passed_over,
    passed_over_in_words,
    plans_in,
    remove_partial_files,
)
from quadpatch_client.journal import Journal
from quadpatch_client.schema import FIGURES, PROBLEM_MEDIA_TYPE, MeshProblem, Problem
from quadpatch_client.sdk import Client
from quadpatch_client.workers import Workers
from tests.waiting import GUARD_S

DONE = Row("a.ply", "done", 5, 1, 2, 1, 1, 70, 2.5, "job_1", "")
WARNED = Row("w.ply", "done_with_warnings", 3, 0, 2, 1, 0, 70, 1.0, "job_2", "the unit is not known")
FAILED = Row("b.ply", "failed", reason="=the file is empty (invalid_mesh)")


@pytest.mark.parametrize(("status", "code"), [(401, "unauthorized"), (403, "scope_missing")])
@pytest.mark.parametrize("words", [["batch", "in", "--out", "out"], ["watch", "in", "--once", "--settle", "0"]])
def test_a_key_that_is_refused_is_no_fault_of_any_file(  # noqa: PLR0917 - what pytest hands over
    server: Any,
    answers: Any,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    words: list[str],
    status: int,
    code: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("in").mkdir()
    for name in ("a.ply", "b.ply"):
        (Path("in") / name).write_bytes(b"ply")
    problem = Problem(type="x", title="x", status=status, code=code, detail="words", instance="x")
    server.answers = [answers["answer"](status, problem.model_dump_json().encode(), Content_Type=PROBLEM_MEDIA_TYPE)]
    done = CliRunner().invoke(app, [*words, "--url", server.url, "--api-key", "wrong"])
    assert done.exit_code == ExitCode.REJECTED, done.stderr
    assert f"({code})" in done.stderr
    assert sorted(path.name for path in Path("in").glob("*.ply")) == ["a.ply", "b.ply"]
    assert not Path("out/summary.csv").exists()


def test_a_batch_that_is_refused_ends_after_the_files_at_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    problem = Problem(type="x", title="x", status=401, code="unauthorized", detail="words", instance="x")
    both_at_work, is_waited_for, ended = threading.Barrier(2), threading.Event(), list[str]()

    def repair(_client: object, plan: FilePlan, *_: object) -> Row:
        both_at_work.wait(GUARD_S)
        if plan.name == "a.ply":
            raise RefusedError(problem)
        is_waited_for.wait(GUARD_S)
        ended.append(plan.name)
        return failure(plan.name, MeshRejectedError(MeshProblem(code="invalid_mesh", message="words")))

    def wait_for(futures: Any, return_when: str = ALL_COMPLETED) -> Any:
        if return_when == ALL_COMPLETED:
            is_waited_for.set()
        return wait(futures, return_when=return_when)

    monkeypatch.setattr("quadpatch_client.batch.repair_file", repair)
    monkeypatch.setattr("quadpatch_client.batch.wait", wait_for)
    for name in ("a.ply", "b.ply"):
        (tmp_path / name).write_bytes(b"ply")
    out = tmp_path / "out"
    plans = plans_in(mesh_files(tmp_path, False), tmp_path, out, None, with_html=False, with_preview=False)
    with Journal(tmp_path / "journal") as journal, Client("http://127.0.0.1:1") as client:
        with pytest.raises(RefusedError):
            Batch(client, plans, JobOptions(), journal, 2).run(lambda _: None)
        assert ended == ["b.ply"]


def test_the_summary_counts_and_names_what_failed() -> None:
    console = Console(width=80, file=io.StringIO())
    print_summary(console, [DONE, WARNED, FAILED, Row("c.ply", "skipped", reason="holes is 0, not > 0")])
    text = console.file.getvalue()  # type: ignore[attr-defined]
    assert "1 done, 1 done with warnings, 1 skipped, 1 failed" in text
    assert "WARNING: the unit is not known" in " ".join(text.split())
    assert "b.ply: failed: =the file is empty (invalid_mesh)" in text
    assert all(len(line) <= 80 for line in text.splitlines())


def test_a_file_is_told_in_a_line() -> None:
    assert row_text(DONE) == "a.ply: 3 of 5 holes filled, 2 left open, 2.5 s"
    assert row_text(WARNED) == "w.ply: 2 of 3 holes filled, 1 left open, 1.0 s; WARNING: the unit is not known"


def test_no_text_of_others_becomes_a_formula_in_a_spreadsheet(tmp_path: Path) -> None:
    write_csv(tmp_path / "s.csv", [DONE, FAILED])
    lines = (tmp_path / "s.csv").read_text("utf-8-sig").splitlines()
    assert lines[0] == ",".join(FIGURES)
    rows = list(csv.DictReader(lines))
    assert (rows[0]["mesh_name"], rows[0]["state"], rows[0]["holes_found"]) == ("a.ply", "succeeded", "5")
    assert rows[1]["reason"] == "'=the file is empty (invalid_mesh)"


def test_the_document_names_every_column_of_the_summary(tmp_path: Path) -> None:
    write_csv(tmp_path / "s.csv", [])
    columns = (tmp_path / "s.csv").read_text("utf-8-sig").strip().split(",")
    text = (Path(__file__).resolve().parents[2] / "docs" / "client.md").read_text("utf-8")
    assert re.findall(r"^\| `(\w+)` \|", text.partition("| column |")[2].partition("\n\n")[0], re.M) == columns


def test_meshes_are_found_by_their_suffix(tmp_path: Path) -> None:
    for name in ("b.STL", "a.ply", ".hidden.ply", "notes.txt", "in/c.obj", "out/d.ply", ".git/e.ply"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(b"")
    names = [path.relative_to(tmp_path).as_posix() for path in mesh_files(tmp_path, True, tmp_path / "out")]
    assert names == ["a.ply", "b.STL", "in/c.obj"]
    assert [path.name for path in mesh_files(tmp_path, False)] == ["a.ply", "b.STL"]
    assert inner_folders(tmp_path, tmp_path / "out") == ["in"]
    others = passed_over(tmp_path, True, tmp_path / "out")
    hidden = "hidden: the name begins with a dot"
    assert others == {hidden: [".hidden.ply"], "no suffix of a mesh": ["notes.txt"]}
    assert passed_over_in_words(others) == f".hidden.ply ({hidden}); notes.txt (no suffix of a mesh)"


def test_at_most_twenty_names_are_said() -> None:
    said = passed_over_in_words({"no suffix of a mesh": [f"{i}.txt" for i in range(1023)]})
    assert said.endswith("19.txt and 1,003 more (no suffix of a mesh)")


def test_two_files_never_share_a_place() -> None:
    folder, out = Path("in"), Path("out")
    plans = plans_in(iter([folder / "a.ply", folder / "a.gltf"]), folder, out, None, with_html=True, with_preview=True)
    assert [plan.output.name for plan in plans] == ["a.ply", "a.glb"]
    assert plans[1].outputs()[0] == out / "a.glb.report.json"
    with pytest.raises(UsageError, match=r"would both become out/a\.obj"):
        plans_in(iter([folder / "a.ply", folder / "a.stl"]), folder, out, "obj", with_html=False, with_preview=False)


def test_what_a_killed_client_left_is_removed(tmp_path: Path) -> None:
    for name in (".a.ply.x.part", "a.part", "b.ply"):
        (tmp_path / name).write_bytes(b"")
    remove_partial_files(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.part", "b.ply"]


def test_workers_hand_back_results_and_errors_and_keep_nothing_from_ending() -> None:
    workers = Workers(2)
    started, is_over = threading.Barrier(3), threading.Event()

    def wait_for_the_others() -> int:
        started.wait(GUARD_S)
        is_over.wait(GUARD_S)
        return 7

    futures = [workers.submit(wait_for_the_others) for _ in range(2)]
    started.wait(GUARD_S)
    is_over.set()
    assert [future.result(GUARD_S) for future in futures] == [7, 7]
    with pytest.raises(ZeroDivisionError):
        workers.submit(lambda: 1 // 0).result(GUARD_S)
    assert all(thread.daemon for thread in threading.enumerate() if "_work" in thread.name)
