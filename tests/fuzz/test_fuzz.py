import functools
import tempfile
from pathlib import Path

import numpy as np
import pytest

from tests.fuzz.__main__ import main
from tests.fuzz.campaign import KINDS, Outcome, damaged, run

SEED, COUNT = 1, 60


@functools.cache
def outcome_of(number: int) -> Outcome:
    with tempfile.TemporaryDirectory(prefix="quadpatch-fuzz-") as folder:
        return run(SEED, number, Path(folder))


@pytest.mark.parametrize("number", range(COUNT))
def test_a_damaged_mesh_is_repaired_or_refused_with_a_code(number: int) -> None:
    outcome = outcome_of(number)
    assert not outcome.crash, outcome.crash
    assert outcome.is_kept


def test_every_fault_of_an_output_is_named_in_its_report() -> None:
    unnamed = [outcome for number in range(COUNT) if (outcome := outcome_of(number)).unnamed]
    assert not unnamed


def test_the_runs_fill_holes_and_take_turns_among_all_kinds_of_damage() -> None:
    outcomes = [outcome_of(number) for number in range(COUNT)]
    assert {outcome.kind for outcome in outcomes if outcome.filled} == set(KINDS)


def test_seed_and_number_alone_say_what_the_mesh_is() -> None:
    one, again, other = damaged(3, 5), damaged(3, 5), damaged(4, 5)
    assert (one.kind, one.format, one.options) == (again.kind, again.format, again.options)
    assert one.mesh.vertices.tobytes() == again.mesh.vertices.tobytes()
    assert np.array_equal(one.mesh.triangles, again.mesh.triangles)
    assert one.mesh.vertices.tobytes() != other.mesh.vertices.tobytes()


def test_a_fault_counts_only_as_far_as_the_report_does_not_name_it() -> None:
    named = Outcome("holes", 0, folds=2, crossings=3, named_folds=2, named_crossings=3)
    assert named.is_sound
    unnamed = Outcome("holes", 0, folds=2, crossings=3, named_folds=1, named_crossings=9)
    assert (unnamed.unnamed, unnamed.is_sound) == (1, False)
    assert not Outcome("holes", 0, is_kept=False).is_sound
    assert not Outcome("holes", 0, crash="ValueError").is_sound


def test_the_command_prints_a_table_and_keeps_the_files_of_runs_with_faults_only(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = main(["--count", "2", "--first", "3", "--seed", str(SEED), "--keep", str(tmp_path)])
    table = capsys.readouterr().out
    assert table.splitlines()[-1].split()[:2] == ["all", "2"]
    outcomes = outcome_of(3), outcome_of(4)
    assert code == (not all(outcome.is_sound for outcome in outcomes))
    kept = {path.name for path in tmp_path.iterdir()} if tmp_path.exists() else set()
    assert kept == {f"seed{SEED}_{outcome.number}" for outcome in outcomes if not outcome.is_sound}
