"""Models, rules, keys, trainings and plans on the command line, against a real local stack.

Also tests `quadpatch_client.catalogue`, `quadpatch_client.catalogue_commands`, `quadpatch_client.rule_commands` and
`quadpatch_client.plan_command`.
"""

import json
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import httpx
import pytest
from typer.testing import CliRunner, Result

from quadpatch_client.cli import app
from quadpatch_client.exit_codes import ExitCode
from tests.integration.test_batch import small_scans
from tests.waiting import GUARD_S

KEY = "0123456789abcdef0123456789abcdef"


def run_with(url: str, *arguments: str | Path, **variables: str) -> Result:
    environment = {"QUADPATCH_CLIENT_URL": url, "COLUMNS": "80", **variables}
    return CliRunner().invoke(app, [*map(str, arguments)], env=environment)


@pytest.fixture
def run(local_stack: Any) -> Callable[..., Result]:
    return partial(run_with, local_stack.url)


def test_a_saved_rule_is_listed_planned_and_followed(
    run: Callable[..., Result], local_stack: Any, relief_file: Callable[[str], Path], tmp_path: Path
) -> None:
    content = {"description": "narrow ones", "holes": {"max_diameter": 0.01}, "method": {"method": "smooth"}}
    httpx.put(f"{local_stack.url}/v1/rules/narrow", json=content, timeout=GUARD_S).raise_for_status()
    listed = run("rules")
    assert listed.exit_code == ExitCode.OK, listed.stderr
    assert "narrow@1" in listed.stdout
    assert "max diameter 0.01" in listed.stdout
    # Other tests save rules on the same stack.
    assert "narrow" in {rule["name"] for rule in json.loads(run("rules", "--json").stdout)}
    planned = run("plan", relief_file("float.ply"), "--saved-rule", "narrow")
    assert planned.exit_code == ExitCode.OK, planned.stderr
    assert "float.ply: fill 0 of 5 holes" in planned.stdout
    done = run("repair", relief_file("float.ply"), "-o", tmp_path / "out.ply", "--saved-rule", "narrow@1")
    assert "5 left open by rule" in done.stderr


def test_a_rule_is_saved_shown_and_saved_again(run: Callable[..., Result], tmp_path: Path) -> None:
    content = {"holes": {"max_diameter": 20.0}, "acceptance": {"min_confidence": 0.8}}
    file = tmp_path / "rule.json"
    file.write_text(json.dumps(content))
    assert "saved from-a-file@1" in run("rules", "save", "from-a-file", file).stderr
    shown = run("rules", "show", "from-a-file")
    assert shown.exit_code == ExitCode.OK, shown.stderr
    assert json.loads(shown.stdout) == content
    file.write_text(shown.stdout.replace("20.0", "30.0"))
    saved = run("rules", "save", "from-a-file", file, "--json")
    assert json.loads(saved.stdout)["version"] == 2
    first = json.loads(run("rules", "show", "from-a-file@1", "--json").stdout)
    assert (first["version"], first["content"]["holes"]["max_diameter"]) == (1, 20.0)
    assert "from-a-file@2" in run("rules").stdout


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{", "can't be read as JSON"),
        ("[]", "holds no rule"),
        ('{"holes": {"max_diameter": -1}}', "has to be greater than 0"),
        ('{"hoels": {}}', "hoels"),
    ],
)
def test_what_is_no_rule_is_refused_in_words(run: Callable[..., Result], tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "rule.json").write_text(text)
    refused = run("rules", "save", "wrong", tmp_path / "rule.json")
    assert refused.exit_code == ExitCode.USAGE
    assert said in " ".join(refused.stderr.split())
    assert run("rules", "show", "wrong").exit_code == ExitCode.REJECTED


def test_a_plan_names_model_and_limits(run: Callable[..., Result], relief_file: Callable[[str], Path]) -> None:
    planned = run("plan", relief_file("float.ply"), "--method", "dictionary", "--max-diameter", "5")
    assert planned.exit_code == ExitCode.OK, planned.stderr
    first, model, limits = planned.stdout.splitlines()
    assert first == "float.ply: fill 4 of 5 holes"
    assert model == "model: default (general-dictionary@1)"
    assert "MiB for each attempt" in limits
    assert json.loads(run("plan", relief_file("float.ply"), "--json").stdout)["selected"] == 4


def test_keys_are_made_listed_and_revoked_and_others_are_told_as_wrong(
    run_stack: Callable[..., Any], tmp_path: Path
) -> None:
    with run_stack(QUADPATCH_API_KEYS=KEY) as stack:
        run = partial(run_with, stack.url, QUADPATCH_CLIENT_API_KEY=KEY)
        check_keys(run)
        assert run("doctor").exit_code == ExitCode.OK
        reader = json.loads(run("keys", "make", "reader", "--scope", "read", "--json").stdout)["key"]
        check_refusals(partial(run_with, stack.url), reader, tmp_path)


def check_keys(run: Callable[..., Result]) -> None:
    made = run("keys", "make", "station 4", "--scope", "read", "--days", "1", "--json")
    assert made.exit_code == ExitCode.OK, made.stderr
    key = json.loads(made.stdout)
    assert (key["scopes"], bool(key["expires_at"])) == (["read"], True)
    assert len(run("keys", "make", "station 5").stdout.strip()) > 20
    listed = run("keys", "list")
    assert "station 4" in listed.stdout
    assert key["key"] not in listed.stdout
    assert all(len(line) <= 80 for line in listed.stdout.splitlines())
    assert run("keys", "revoke", key["id"]).exit_code == ExitCode.OK
    wrong = run("keys", "make", "station 6", "--scope", "repiar")
    assert "there is no scope 'repiar'; did you mean 'repair'?" in wrong.stderr
    states = {k["id"]: k["revoked_at"] for k in json.loads(run("keys", "list", "--json").stdout)}
    assert states[key["id"]] is not None


def check_refusals(run: Callable[..., Result], reader: str, folder: Path) -> None:
    small_scans(folder / "in", 2, "refused")
    for key, looked, said in (
        ("", "asks for a key", "--api-key or QUADPATCH_CLIENT_API_KEY"),
        ("wrong", "does not know this key", "--api-key or QUADPATCH_CLIENT_API_KEY"),
        (reader, "of tenant default", "(scope_missing)"),
    ):
        look = run("doctor", QUADPATCH_CLIENT_API_KEY=key)
        assert looked in look.stdout
        assert look.exit_code == (ExitCode.OK if key == reader else ExitCode.REJECTED)
        for words in (["batch", folder / "in", "--out", folder / "out"], ["watch", folder / "in", "--once"]):
            done = run(*words, QUADPATCH_CLIENT_API_KEY=key)
            assert done.exit_code == ExitCode.REJECTED, done.stderr
            assert said in done.stderr
            assert "next try" not in done.stderr
    assert not (folder / "out" / "summary.csv").exists()


def test_a_model_is_learned_and_judged(run: Callable[..., Result], relief_file: Callable[[str], Path]) -> None:
    meshes = [relief_file("float.ply"), relief_file("binary.stl")]
    done = run("train", "learned-here", *meshes, "--atoms", "8", "--steps", "1")
    assert done.exit_code == ExitCode.OK, done.stderr
    assert "learned-here@1: " in done.stderr
    assert "learned-here@1" in run("models").stdout
    wrong = run("train", "learned-here", *meshes, "--atoms", "7")
    assert wrong.exit_code == ExitCode.USAGE
    assert "--atoms has to be at least 8, not 7" in wrong.stderr


def test_an_unknown_model_is_told_with_the_one_that_may_be_meant(
    run: Callable[..., Result], relief_file: Callable[[str], Path], tmp_path: Path
) -> None:
    arguments = ["repair", relief_file("float.ply"), "-o", tmp_path / "out.ply", "--model"]
    done = run(*arguments, "general-dictionry")
    assert done.exit_code == ExitCode.REJECTED
    assert "did you mean 'general-dictionary'?" in done.stderr
    assert "did you mean 'smooth'?" in run(*arguments, "smoth").stderr
    assert "say --method smooth" in run(*arguments, "smooth").stderr


def test_jobs_are_searched_and_fit_a_terminal(
    run: Callable[..., Result], relief_file: Callable[[str], Path], tmp_path: Path
) -> None:
    scan = relief_file("float.ply").rename(tmp_path / "searched.ply")
    assert run("repair", scan, "-o", tmp_path / "out.ply", "--method", "smooth").exit_code == ExitCode.OK
    found = json.loads(run("jobs", "--filename", "searched.ply", "--since", "1h", "--task", "fill", "--json").stdout)
    assert [job["spec"]["label"] for job in found] == ["searched.ply"]
    assert json.loads(run("jobs", "--filename", "searched.ply", "--since", "2100-01-01", "--json").stdout) == []
    table = run("jobs").stdout
    assert "searched.ply" in table
    assert all(len(line) <= 80 for line in table.splitlines())
    assert found[0]["id"] in table
    assert run("jobs", "--since", "yesterday").exit_code == ExitCode.USAGE
