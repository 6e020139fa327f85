"""`quadpatch-client batch` against a real local stack.

Also tests `quadpatch_client.batch`, `quadpatch_client.batch_command` and `quadpatch_client.file_repair`.
"""

import csv
import hashlib
import json
import os
import signal
import subprocess
import sys
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import httpx
import pytest
from typer.testing import CliRunner, Result

from quadpatch_client.batch import JOURNAL
from quadpatch_client.cli import app
from quadpatch_client.exit_codes import ExitCode
from quadpatch_client.schema import FIGURES
from quadpatch_client.sdk import Client
from tests.integration.conftest import ply_bytes, punched_relief
from tests.waiting import GUARD_S, wait_until

SMOOTH = ["--method", "smooth"]


@pytest.fixture
def run(local_stack: Any) -> Callable[..., Result]:
    def run_client(*arguments: str | Path) -> Result:
        return CliRunner().invoke(app, [*map(str, arguments)], env={"QUADPATCH_CLIENT_URL": local_stack.url})

    return run_client


def small_scans(folder: Path, n: int, prefix: str) -> list[str]:
    """Reliefs of two holes, each a little higher than the one before it."""
    folder.mkdir(parents=True, exist_ok=True)
    vertices, triangles = punched_relief(14, n_holes=2, radius=0.12)
    for i in range(n):
        content = ply_bytes(vertices * (1.0, 1.0, 1.0 + i / n), triangles)
        (folder / f"{prefix}_{i:03}.ply").write_bytes(content)
    return sorted(path.name for path in folder.glob("*.ply"))


def done_in(journal: Path) -> set[str]:
    """Names of the files that a journal says are done."""
    lines = journal.read_text("utf-8").splitlines() if journal.exists() else []
    entries = [json.loads(line) for line in lines if line.endswith("}}")]
    return {entry["file"] for entry in entries if entry["state"] == "done"}


def has_done(journal: Path, enough: int) -> bool:
    return len(done_in(journal)) >= enough


def check_batch_that_is_killed(url: str, folder: Path, n: int, kills: int) -> None:
    prefix = f"killed{n}"
    names = small_scans(folder / "in", n, prefix)
    out = folder / "out"
    command = [sys.executable, "-m", "quadpatch_client", "batch", str(folder / "in"), "--out", str(out), *SMOOTH]
    environment = {**os.environ, "QUADPATCH_CLIENT_URL": url}
    for kill in range(1, kills + 1):
        with (folder / "log").open("a") as log, subprocess.Popen(command, stderr=log, env=environment) as process:
            wait_until(partial(has_done, out / JOURNAL, kill * n // (kills + 1)))
            process.send_signal(signal.SIGKILL)
    assert len(done_in(out / JOURNAL)) < n, "it was over before it could be killed"
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=GUARD_S, check=False)
    assert done.returncode == 0, done.stderr
    assert "files were finished before" in done.stderr
    assert sorted(path.name for path in out.glob("*.ply")) == names
    assert not list(out.glob(".*.part"))
    with Client(url) as client:
        jobs = Counter(job.mesh_name for job in client.jobs(label=f"{prefix}_*"))
    assert jobs == dict.fromkeys(names, 1)


def test_a_batch_that_is_killed_repairs_each_file_once(local_stack: Any, tmp_path: Path) -> None:
    check_batch_that_is_killed(local_stack.url, tmp_path, 12, 2)


@pytest.mark.slow
def test_a_hundred_files_are_repaired_once_each_though_the_batch_is_killed_three_times(
    local_stack: Any, tmp_path: Path
) -> None:
    check_batch_that_is_killed(local_stack.url, tmp_path, 100, 3)


def test_results_lie_where_their_scans_do_and_the_summary_tells_of_all(
    run: Callable[..., Result], tmp_path: Path
) -> None:
    folder, out = tmp_path / "in", tmp_path / "out"
    small_scans(folder / "deep", 1, "summed")
    small_scans(folder, 2, "summed")
    (folder / "broken.stl").write_bytes(os.urandom(300))
    (folder / "notes.txt").write_text("no mesh")
    options = ["--recursive", "--where", "name!=*_001*", "--html", *SMOOTH]
    done = run("batch", folder, "--out", out, *options)
    assert done.exit_code == ExitCode.JOB_FAILED, done.stderr
    assert "2 done, 1 skipped, 1 failed" in done.stdout
    assert "broken.stl: failed" in done.stdout
    for name in ("summed_000.ply", "deep/summed_000.ply"):
        assert (out / name).read_bytes().startswith(b"ply")
        assert json.loads((out / f"{name}.report.json").read_text())["counts"]["found"] == 3
        assert (out / f"{name}.report.html").read_text().lower().startswith("<!doctype html>")
    with (out / "summary.csv").open(encoding="utf-8-sig", newline="") as file:
        rows = {row["mesh_name"]: row for row in csv.DictReader(file)}
    assert {name: (row["state"], row["file"]) for name, row in rows.items()} == {
        "broken.stl": ("failed", ""),
        "deep/summed_000.ply": ("succeeded", "deep/summed_000.ply"),
        "summed_000.ply": ("succeeded", "summed_000.ply"),
        "summed_001.ply": ("skipped", ""),
    }
    row = rows["summed_000.ply"]
    assert row["holes_filled_smooth"] == "2"
    assert row["file_sha256"] == hashlib.sha256((out / "summed_000.ply").read_bytes()).hexdigest()
    assert tuple(row) == FIGURES
    assert "passed over: notes.txt (no suffix of a mesh)" in done.stderr
    assert rows["summed_001.ply"]["reason"] == "name is summed_001.ply, not != *_001*"


def test_a_result_with_warnings_is_no_clean_success(
    run: Callable[..., Result], local_stack: Any, tmp_path: Path
) -> None:
    rule = {"method": {"method": "smooth"}, "acceptance": {"max_expected_error": 1e-9}}
    httpx.put(f"{local_stack.url}/v1/rules/exact", json=rule, timeout=GUARD_S).raise_for_status()
    folder, out = tmp_path / "in", tmp_path / "out"
    small_scans(folder, 1, "warned")
    for _ in ("repaired", "found in the journal"):
        done = run("batch", folder, "--out", out, "--saved-rule", "exact")
        assert done.exit_code == ExitCode.OK, done.stderr
        assert "1 done with warnings" in done.stdout
        assert "WARNING: " in done.stdout
        with (out / "summary.csv").open(encoding="utf-8-sig", newline="") as file:
            (row,) = csv.DictReader(file)
        assert (row["state"], row["warnings"]) == ("succeeded_with_warnings", "1")
        assert "exact@1" in row["reason"]
    assert "1 of 1 files were finished before" in done.stderr
    watched = run("watch", folder, "--once", "--settle", "0", "--saved-rule", "exact")
    assert "warned_000.ply: 2 of 3 holes filled, 1 left open" in watched.stderr
    assert "; WARNING: " in watched.stderr


def test_files_are_chosen_by_what_the_analysis_finds(run: Callable[..., Result], tmp_path: Path) -> None:
    folder, out = tmp_path / "in", tmp_path / "out"
    small_scans(folder, 1, "chosen")
    options = ["--where", "holes>0", "--where", "triangles>1000", "--json", "--quiet", *SMOOTH]
    done = run("batch", folder, "--out", out, *options)
    assert done.exit_code == ExitCode.OK, done.stderr
    (row,) = json.loads(done.stdout)
    assert row["state"] == "skipped"
    assert "not > 1000" in row["reason"]


def test_what_failed_is_tried_again_and_a_file_that_changed_is_repaired_anew(
    run: Callable[..., Result], tmp_path: Path
) -> None:
    folder, out = tmp_path / "in", tmp_path / "out"
    small_scans(folder, 2, "again")
    whole = (folder / "again_000.ply").read_bytes()
    (folder / "again_000.ply").write_bytes(whole[:400])
    assert run("batch", folder, "--out", out, *SMOOTH).exit_code == ExitCode.JOB_FAILED
    (folder / "again_000.ply").write_bytes(whole)
    done = run("batch", folder, "--out", out, *SMOOTH)
    assert done.exit_code == ExitCode.OK, done.stderr
    assert "1 of 2 files were finished before" in done.stderr
    assert "2/2  again_000.ply: 2 of 3 holes filled, 1 left open" in done.stderr


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--out", "in"], "results would take the place of the scans"),
        (["--out", "out", "--where", "hole>0"], "did you mean holes?"),
        (["--out", "out", "--format", "stl"], "would both become out/two.stl"),
        (["--out", "out", "--max-diameter", "-1"], "max-diameter"),
    ],
)
def test_what_makes_no_sense_is_said_before_anything_is_sent(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], words: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("in").mkdir()
    for name in ("two.ply", "two.obj"):
        (Path("in") / name).write_bytes(b"x")
    done = CliRunner().invoke(app, ["batch", "in", *arguments, "--url", "http://127.0.0.1:9"])
    assert done.exit_code == ExitCode.USAGE
    assert words in done.stderr


@pytest.mark.parametrize(
    ("options", "code"), [(["--saved-rule", "no-such"], "rule_not_found"), (["--model", "no-such"], "model_not_found")]
)
def test_what_would_be_refused_for_every_file_ends_the_batch_at_once(
    run: Callable[..., Result], tmp_path: Path, options: list[str], code: str
) -> None:
    folder, out = tmp_path / "in", tmp_path / "out"
    small_scans(folder, 3, "refused")
    done = run("batch", folder, "--out", out, "--parallel", "1", *options)
    assert done.exit_code == ExitCode.REJECTED, done.stderr
    assert f"({code})" in done.stderr
    assert "refused_000.ply" not in done.stderr
    assert not (out / "summary.csv").exists()
    assert (out / JOURNAL).read_text() == ""


def test_a_service_that_is_away_ends_the_batch_with_what_to_do(tmp_path: Path) -> None:
    small_scans(tmp_path / "in", 1, "away")
    arguments = ["batch", str(tmp_path / "in"), "--out", str(tmp_path / "out"), "--url", "http://127.0.0.1:9"]
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == ExitCode.UNREACHABLE
    assert "with the same options goes on" in done.stderr
