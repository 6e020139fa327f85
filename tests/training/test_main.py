"""The command line, end to end, on small meshes.

Also tests `training.card` and `training.run`.
"""

import hashlib
import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from jobkit.database.session import Database
from jobkit.models.registry import Registry
from jobkit.storage.open import open_store
from quadpatch.errors import OptionError
from quadpatch.inpainters.model_file import load_model, model_card
from quadpatch.options import HoleOptions, PatchOptions, RepairOptions
from quadpatch.repair import repair_file
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import punched
from training.__main__ import app
from training.procedural import relief_mesh


def write_ply(path: Path, mesh: TriangleMesh) -> Path:
    header = (
        f"ply\nformat ascii 1.0\nelement vertex {len(mesh.vertices)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(mesh.triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = [" ".join(map(repr, vertex)) for vertex in mesh.vertices.tolist()]
    rows += [f"3 {a} {b} {c}" for a, b, c in mesh.triangles.tolist()]
    path.write_text(header + "\n".join(rows) + "\n")
    return path


@pytest.fixture(scope="module")
def meshes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("corpus")
    for seed, name in enumerate(("waves", "scales", "noise")):
        write_ply(folder / f"{name}.ply", relief_mesh(name, np.random.default_rng(seed), 40))
    entry = {"name": "waves", "licence": "CC BY 4.0 (a surveyor)"}
    (folder / "manifest.json").write_text(json.dumps([entry]))
    return folder


SMALL = ["--atoms", "24", "--resolution", "8", "--nonzero", "3", "--iterations", "3", "--overlap", "0"]


def train(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> str:
    """Run the command as if typed, and return what it printed."""
    monkeypatch.setattr("sys.argv", ["training", *arguments])
    result = CliRunner().invoke(app, list(arguments))
    assert result.exit_code == 0, result.output
    return result.output


def test_a_dictionary_is_learned_described_and_repeated_bit_for_bit(
    meshes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = tmp_path / "one.safetensors", tmp_path / "elsewhere" / "two.safetensors"
    second.parent.mkdir()
    shared = [str(meshes), "--name", "small@3", *SMALL, "--holdout", "noise", "--seed", "5"]
    output = train(monkeypatch, "dictionary", *shared, "--output", str(first), "--curve", str(tmp_path / "c.json"))
    train(monkeypatch, "dictionary", *shared, f"--output={second}")
    assert first.read_bytes() == second.read_bytes()
    assert hashlib.sha256(first.read_bytes()).hexdigest() in output
    model = load_model(first)
    assert model.dictionary is not None
    assert model.dictionary.atoms.shape == (64, 24)
    card = model.card
    assert (card["name"], card["version"], card["n_nonzero"], card["seed"]) == ("small", 3, 3, 5)
    assert [mesh["name"] for mesh in card["training_corpus"]] == ["scales", "waves"]
    assert [mesh["name"] for mesh in card["held_out"]] == ["noise"]
    assert card["metrics"]["scan_n_patches"] > 10
    assert card["command"] == typed(meshes.name)
    errors = json.loads((tmp_path / "c.json").read_text())["rms_error"]
    assert errors == sorted(errors, reverse=True)
    page = first.with_suffix(".md").read_text("utf-8")
    assert page.startswith("# small@3\n")
    for fact in ("CC BY 4.0 (a surveyor)", "GPL-3.0-or-later", card["corpus_sha256"], card["command"]):
        assert fact in page
    assert str(tmp_path) not in page


def typed(folder: str) -> str:
    return f"python -m training dictionary {folder} --name small@3 {' '.join(SMALL)} --holdout noise --seed 5"


def test_dictionaries_are_registered_as_versions_of_their_name(
    meshes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("QUADPATCH_DATA_DIR", str(tmp_path / "data"))
    file = tmp_path / "own.safetensors"
    command = ["dictionary", str(meshes / "waves.ply"), "--name", "own", *SMALL, "--output", str(file), "--register"]
    assert "registered as own@1" in train(monkeypatch, *command)
    assert "registered as own@2" in train(monkeypatch, *command, "--seed", "1")
    database = Database(f"sqlite:///{tmp_path / 'data' / 'quadpatch.db'}")
    registry = Registry(database, open_store(f"file://{tmp_path / 'data' / 'objects'}"))
    version = registry.resolve("own")
    database.close()
    assert version.version == 2
    assert version.sha256 == hashlib.sha256(file.read_bytes()).hexdigest()
    assert version.card.n_atoms == 24
    assert version.card.licence == "GPL-3.0-or-later"
    assert version.card.extra["training_corpus"] == model_card(file)["training_corpus"]


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["nowhere.ply", "--name", "a"], "unreadable_mesh"),
        (["{meshes}", "--name", "A b"], "invalid_option"),
        (["{meshes}", "--name", "a", "--patch-length", "long"], "invalid_option"),
        (["{meshes}", "--name", "a", "--patch-length", "-1"], "invalid_option"),
        (["{meshes}", "--name", "a", "--patch-length", "nan"], "invalid_option"),
        (["{meshes}", "--name", "a", "--holdout", "mesh"], "invalid_option"),
        (["{meshes}", "--name", "a", "--output", "a.pkl"], "invalid_option"),
        (["{meshes}", "--name", "a", "--atoms", "100000", *SMALL[2:]], "invalid_option"),
    ],
)
def test_what_cannot_work_is_answered_with_a_code(
    meshes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], code: str
) -> None:
    monkeypatch.chdir(tmp_path)
    filled_in = [argument.format(meshes=meshes) for argument in arguments]
    result = CliRunner().invoke(app, ["dictionary", *filled_in])
    assert result.exit_code == 1
    assert f"error ({code})" in result.output
    assert list(tmp_path.iterdir()) == []


def test_a_dictionary_of_heights_is_learned_for_the_recipe_of_the_paper_and_repairs_by_it(
    meshes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "heights.safetensors"
    shared = ["dictionary", str(meshes), "--name", "heights", "--recipe", "paper", *SMALL, "--overlap", "2"]
    shared += ["--holdout", "noise"]
    output = train(monkeypatch, *shared, "--output", str(file))
    assert "error by iteration" in output
    model = load_model(file)
    assert (model.recipe, model.card["normalisation"]) == ("paper", "heights")
    assert "heights over the plane of the patch" in model.card["recipe"]["signal"]
    assert "times 1" in model.card["recipe"]["training_patch_length"]
    assert model.card["metrics"]["scan_n_patches"] > 10
    errors = model.card["recipe"]["rms_error_by_iteration"]
    assert 0 < errors[-1] < errors[0] < 1
    damaged = punched(relief_mesh("waves", np.random.default_rng(7), 50), (0.0, 0.0, 0.0), radius=4.0)
    source = write_ply(tmp_path / "scan.ply", damaged)
    options = RepairOptions(HoleOptions(ids=(1,)), PatchOptions(length=10.0), recipe="paper")
    report = repair_file(source, tmp_path / "out.ply", file, options)
    assert report["counts"]["filled"] == 1
    with pytest.raises(OptionError, match="learned for the recipe paper"):
        repair_file(source, tmp_path / "out.ply", file)
