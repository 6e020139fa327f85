"""`python -m training corpus` and `network`, end to end, on small meshes."""

import hashlib
import json
import os
import signal
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from jobkit.database.session import Database
from jobkit.models.registry import Registry
from jobkit.storage.open import open_store
from quadpatch.inpainters.onnx_network import AutoencoderInpainter
from quadpatch.options import HoleOptions, PatchOptions, RepairOptions
from quadpatch.repair import repair_file
from tests.quadpatch.shapes import punched
from tests.training.patches import write_corpus
from tests.training.test_main import write_ply
from tests.waiting import GUARD_S, wait_until
from training.__main__ import app
from training.commands import INTERRUPTED
from training.procedural import relief_mesh
from training.shards import Corpus

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
SMALL = ["--places", "40", "--overlap", "0", "--edges", "8.0"]
SHORT = ["--steps", "12", "--batch", "8", "--precision", "float32", "--device", "cpu"]


@pytest.fixture(scope="module")
def corpus(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("corpora") / "corpus"
    write_corpus(folder)
    return folder


def call(*arguments: str | Path, code: int = 0) -> str:
    typed = [str(argument) for argument in arguments]
    result = CliRunner().invoke(app, typed)
    assert result.exit_code == code, result.output
    return result.output


def network(corpus: Path, *arguments: str | Path) -> list[str | Path]:
    return ["network", "--arch", "small_4x", "--corpus", corpus, *SHORT, *arguments]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with `scans`, the `corpus` cut from them, the network `own.onnx` trained on it, and its curve."""
    folder = tmp_path_factory.mktemp("made")
    (folder / "scans").mkdir()
    for seed, name in enumerate(("waves", "scales", "noise")):
        write_ply(folder / "scans" / f"{name}.ply", relief_mesh(name, np.random.default_rng(seed), 45))
    manifest = [{"name": "waves", "licence": "CC BY 4.0 (a surveyor)"}]
    (folder / "scans" / "manifest.json").write_text(json.dumps(manifest))
    with pytest.MonkeyPatch.context() as patch:
        for arguments in (
            ["corpus", folder / "scans", "--output", folder / "corpus", "--holdout", "noise", *SMALL],
            [
                *network(folder / "corpus", "--name", "own@2", "--output", folder / "own.onnx"),
                "--curve",
                folder / "c.json",
            ],
        ):
            patch.setattr("sys.argv", ["training", *map(str, arguments)])
            call(*arguments)
    return folder


def test_a_network_says_what_it_was_trained_on_and_how_well(made: Path) -> None:
    card = AutoencoderInpainter.load(made / "own.onnx").card
    assert (card["name"], card["version"], card["seed"], card["licence"]) == ("own", 2, 0, "GPL-3.0-or-later")
    assert [mesh["name"] for mesh in card["training_corpus"]] == ["scales", "waves"]
    assert [mesh["name"] for mesh in card["held_out"]] == ["noise"]
    assert card["corpus_sha256"] == Corpus.open(made / "corpus").sha256
    assert card["metrics"]["scan_n_patches"] > 5
    assert card["metrics"]["scan_hole_25_to_plate"] > 0
    losses = json.loads((made / "c.json").read_text())["validation_loss"]
    assert card["metrics"]["validation_loss"] == pytest.approx(min(losses), abs=1e-6)
    assert card["command"] == (
        f"python -m training corpus scans --output corpus --holdout noise {' '.join(SMALL)}\n"
        f"python -m training network --arch small_4x --corpus corpus {' '.join(SHORT)} --name own@2"
    )


def test_the_page_of_a_network_says_the_same_and_nothing_of_this_machine(made: Path) -> None:
    card = AutoencoderInpainter.load(made / "own.onnx").card
    page = (made / "own.md").read_text("utf-8")
    digest = hashlib.sha256((made / "own.onnx").read_bytes()).hexdigest()
    assert page.startswith("# own@2\n")
    for fact in ("CC BY 4.0 (a surveyor)", "autoencoder", card["corpus_sha256"], card["command"], digest):
        assert fact in page
    for text in (page, json.dumps(card)):
        assert str(made) not in text


def test_nothing_is_left_behind_but_what_was_asked_for(made: Path) -> None:
    assert sorted(path.name for path in made.iterdir()) == ["c.json", "corpus", "own.md", "own.onnx", "scans"]


def test_a_network_repairs_a_scan(made: Path, tmp_path: Path) -> None:
    damaged = punched(relief_mesh("waves", np.random.default_rng(7), 50), (0.0, 0.0, 0.0), radius=4.0)
    source = write_ply(tmp_path / "scan.ply", damaged)
    options = RepairOptions(HoleOptions(ids=(1,)), PatchOptions(length=10.0))
    report = repair_file(source, tmp_path / "out.ply", made / "own.onnx", options)
    assert report["counts"]["filled"] + report["counts"]["filled_smooth"] == 1
    assert report["patches"]["resolution"] == 24


@dataclass(frozen=True)
class Registered:
    """A folder with `own.onnx`, the checkpoint that was asked for and the data of a registry; what was said."""

    folder: Path
    said: str


@pytest.fixture(scope="module")
def registered(corpus: Path, tmp_path_factory: pytest.TempPathFactory) -> Registered:
    folder = tmp_path_factory.mktemp("registered")
    files: list[str | Path] = ["--output", folder / "own.onnx", "--checkpoint", folder / "run.checkpoint"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("QUADPATCH_DATA_DIR", str(folder / "data"))
        return Registered(folder, call(*network(corpus, "--name", "own", *files, "--register")))


def test_a_run_that_was_stopped_goes_on_to_the_same_bytes(corpus: Path, registered: Registered, tmp_path: Path) -> None:
    """Stopped by running out of a smaller budget of the same schedule: see `test_trainer` for any step."""
    checkpoint, resumed = registered.folder / "run.checkpoint", tmp_path / "resumed.onnx"
    call(*network(corpus, "--name", "own", "--output", resumed, "--resume", checkpoint))
    assert (registered.folder / "own.onnx").read_bytes() == resumed.read_bytes()
    assert checkpoint.is_file()


def test_ctrl_c_writes_a_checkpoint_and_says_how_to_go_on(corpus: Path, tmp_path: Path) -> None:
    arguments = network(corpus, "--name", "x", "--output", tmp_path / "x.onnx", "--steps", "1000", "--patience", "99")
    command = [sys.executable, "-m", "training", *map(str, arguments)]
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    process = subprocess.Popen(command, cwd=ROOT, stderr=subprocess.PIPE, text=True, env=environment)
    checkpoint = tmp_path / "x.checkpoint"
    wait_until(lambda: checkpoint.exists() or process.poll() is not None)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=GUARD_S)
    assert process.returncode == INTERRUPTED, said
    assert f"--resume {checkpoint}" in said
    assert not (tmp_path / "x.onnx").exists()
    # The same command, on a budget that is spent by now.
    call(*arguments, "--steps", "1", "--resume", checkpoint)
    assert AutoencoderInpainter.load(tmp_path / "x.onnx").resolution == 24


def test_networks_are_registered_with_the_card_of_their_file(registered: Registered) -> None:
    assert "registered as own@1" in registered.said
    file, data = registered.folder / "own.onnx", registered.folder / "data"
    database = Database(f"sqlite:///{data / 'quadpatch.db'}")
    version = Registry(database, open_store(f"file://{data / 'objects'}")).resolve("own")
    database.close()
    assert (version.kind, version.format) == ("autoencoder", "onnx")
    assert version.sha256 == hashlib.sha256(file.read_bytes()).hexdigest()
    assert version.card.patch_resolution == 24
    assert version.card.metrics["validation_loss"] > 0
    assert version.card.extra["architecture"] == "small_4x"


def test_whole_numbers_come_with_the_accuracy_that_they_cost(corpus: Path, tmp_path: Path) -> None:
    file = tmp_path / "small.onnx"
    said = call(*network(corpus, "--name", "small", "--output", file, "--int8"))
    assert file.stat().st_size < 200_000
    card = AutoencoderInpainter.load(file).card
    assert card["precision"] == "int8"
    for key in ("relief_hole_25_error", "float32_relief_hole_25_error"):
        assert card["metrics"][key] > 0
        assert key in said


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["--name", "A b"], "invalid_option"),
        (["--name", "a", "--arch", "long_7x"], "invalid_option"),
        (["--name", "a", "--arch", "long_12x"], "unusable_corpus"),
        (["--name", "a", "--corpus", "nowhere"], "unusable_corpus"),
        (["--name", "a", "--output", "a.pt"], "invalid_option"),
        (["--name", "a", "--curve", "a.gif"], "invalid_option"),
        (["--name", "a", "--device", "abacus"], "invalid_option"),
        (["--name", "a", "--resume", "nothing.checkpoint"], "unusable_checkpoint"),
    ],
)
def test_what_cannot_work_is_answered_with_a_code(
    corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], code: str
) -> None:
    monkeypatch.chdir(tmp_path)
    assert f"error ({code})" in call(*network(corpus, *arguments), code=1)
    assert not list(tmp_path.glob("*.onnx"))


def test_without_torch_networks_say_what_is_missing_and_dictionaries_do_not_care(corpus: Path) -> None:
    program = (
        "import sys; sys.modules['torch'] = None; from training.__main__ import app; "
        f"app(['network', '--arch', 'small_4x', '--corpus', {str(corpus)!r}, '--name', 'a'])"
    )
    result = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False)
    assert result.returncode == 1
    assert "error (missing_extra): training networks needs torch" in result.stderr


def test_the_command_line_knows_no_torch_before_it_is_needed() -> None:
    program = "import sys, training.__main__; sys.exit('torch' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], cwd=ROOT, check=False).returncode == 0
