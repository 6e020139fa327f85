import errno
import hashlib
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from safetensors.numpy import save

from quadpatch.errors import ModelError
from quadpatch.inpainters import model_file
from quadpatch.inpainters.model_file import SHIPPED_MODELS, load_model, model_card, save_dictionary, shipped_model
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.types import FloatArray


def some_atoms(n_bins: int = 16, n_atoms: int = 20) -> FloatArray:
    atoms = np.random.default_rng(0).normal(size=(n_bins, n_atoms))
    return np.asarray(atoms / np.linalg.norm(atoms, axis=0))


def write(path: Path, atoms: Any = None, **changes: Any) -> Path:
    """Write a good file, or one that differs from a good one in one thing."""
    card = {"kind": "dictionary", "normalisation": "detail-mean-spread", "patch_resolution": 4, "n_nonzero": 3}
    card.update(changes)
    atoms = some_atoms().astype(np.float32) if atoms is None else atoms
    path.write_bytes(save({"atoms": np.ascontiguousarray(atoms)}, {"card": json.dumps(card)}))
    return path


def test_a_dictionary_comes_back_with_its_card(tmp_path: Path) -> None:
    dictionary = Dictionary(some_atoms(), 4, 3)
    path = tmp_path / "waves@1.safetensors"
    save_dictionary(path, dictionary, {"name": "waves", "licence": "CC0-1.0", "attribution": "Zoë"})
    model = load_model(path)
    assert model.kind == "dictionary"
    assert model.dictionary is not None
    np.testing.assert_allclose(model.dictionary.atoms, dictionary.atoms, atol=1e-7)
    np.testing.assert_allclose(np.linalg.norm(model.dictionary.atoms, axis=0), 1.0, rtol=1e-14)
    assert (model.dictionary.resolution, model.dictionary.n_nonzero) == (4, 3)
    assert model.card == model_card(path)
    assert model.card["attribution"] == "Zoë"
    assert (model.card["n_atoms"], model.card["patch_resolution"]) == (20, 4)


def test_writing_what_was_read_gives_the_same_bytes(tmp_path: Path) -> None:
    first, second = tmp_path / "a.safetensors", tmp_path / "b.safetensors"
    save_dictionary(first, Dictionary(some_atoms(), 4, 3), {"name": "a", "seed": 1, "metrics": {"x": 0.1}})
    save_dictionary(second, Dictionary(some_atoms(), 4, 3), {"metrics": {"x": 0.1}, "seed": 1, "name": "a"})
    assert first.read_bytes() == second.read_bytes()


@pytest.mark.parametrize(("normalisation", "recipe"), [("detail-mean-spread", "default"), ("heights", "paper")])
def test_the_normalisation_of_a_dictionary_says_which_recipe_it_is_for(
    tmp_path: Path, normalisation: str, recipe: str
) -> None:
    save_dictionary(tmp_path / "a.safetensors", Dictionary(some_atoms(), 4, 3), {}, normalisation)
    model = load_model(tmp_path / "a.safetensors")
    assert (model.recipe, model.card["normalisation"]) == (recipe, normalisation)


def test_a_network_is_handed_over_unopened(tmp_path: Path) -> None:
    path = tmp_path / "net.onnx"
    path.write_bytes(b"anything")
    model = load_model(path)
    assert (model.kind, model.path, model.dictionary) == ("autoencoder", path, None)


@pytest.mark.parametrize(
    "changes",
    [
        {"kind": "autoencoder"},
        {"normalisation": "none"},
        {"patch_resolution": 5},
        {"patch_resolution": "4"},
        {"patch_resolution": 10**9},
        {"n_nonzero": 0},
        {"n_nonzero": 17},
        {"n_nonzero": True},
        {"n_nonzero": None},
        {"atoms": some_atoms() * 2.0},
        {"atoms": np.where(np.eye(16, 20) > 0, np.nan, some_atoms())},
        {"atoms": np.where(np.eye(16, 20) > 0, np.inf, some_atoms())},
        {"atoms": np.zeros((16, 20))},
        {"atoms": np.zeros((16, 0))},
        {"atoms": np.zeros(16)},
        {"atoms": np.zeros((16, 20), dtype=np.int32)},
        {"atoms": np.zeros((17 * 16, 1), dtype=np.float16)},
    ],
)
def test_a_dictionary_that_contradicts_itself_is_refused(tmp_path: Path, changes: dict[str, Any]) -> None:
    with pytest.raises(ModelError):
        load_model(write(tmp_path / "bad.safetensors", **changes))


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\x00" * 7,
        struct.pack("<Q", 2**63) + b"{}",
        struct.pack("<Q", 900_000) + b"{" * 1000,
        struct.pack("<Q", 5) + b"[1,2]",
        struct.pack("<Q", 2) + b"{}",
        save({"atoms": some_atoms()}),
        save({"atoms": some_atoms()}, {"card": "[" * 100_000}),
        save({"atoms": some_atoms()}, {"card": "[1]"}),
        save({"atoms": some_atoms(), "more": some_atoms()}, {"card": '{"kind": "dictionary"}'}),
    ],
)
def test_a_file_that_is_no_model_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "bad.safetensors"
    path.write_bytes(content)
    with pytest.raises(ModelError):
        load_model(path)


@given(cut=st.integers(0, 1000), position=st.integers(0, 400), value=st.integers(0, 255))
@example(cut=0, position=7, value=0)
@settings(max_examples=150)
def test_a_damaged_file_loads_as_a_dictionary_or_is_refused(
    tmp_path_factory: pytest.TempPathFactory, cut: int, position: int, value: int
) -> None:
    path = tmp_path_factory.getbasetemp() / "damaged.safetensors"
    whole = write(path).read_bytes()
    content = bytearray(whole)
    content[position % len(content)] = value
    damaged = bytes(content[: len(content) - cut % 40])
    path.write_bytes(damaged)
    try:
        model = load_model(path)
    except ModelError:
        # The example above leaves the file as it was: the highest byte of the header's length is 0.
        assert damaged != whole
        return
    assert model.dictionary is not None
    assert np.isfinite(model.dictionary.atoms).all()


@pytest.mark.parametrize("bits", ["7fa00000", "ffa00000", "7f800000"])
def test_a_flipped_bit_that_makes_a_nan_is_refused_without_a_warning(tmp_path: Path, bits: str) -> None:
    """Signalling NaNs raise the processor's flag as soon as they are converted."""
    content = bytearray(write(tmp_path / "a.safetensors").read_bytes())
    content[-4:] = bytes.fromhex(bits)[::-1]
    (tmp_path / "a.safetensors").write_bytes(bytes(content))
    with pytest.raises(ModelError, match="unit norm"):
        load_model(tmp_path / "a.safetensors")


def test_atoms_whose_squares_overflow_are_refused_without_a_warning(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="unit norm"):
        load_model(write(tmp_path / "a.safetensors", some_atoms() * 1e200))


def test_a_missing_file_and_a_foreign_suffix_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="no model file"):
        load_model(tmp_path / "nothing.safetensors")
    foreign = tmp_path / "weights.pkl"
    foreign.write_bytes(b"cos\nsystem\n")
    with pytest.raises(ModelError, match="ends in"):
        load_model(foreign)
    with pytest.raises(ModelError, match="safetensors"):
        save_dictionary(tmp_path / "a.npz", Dictionary(some_atoms(), 4, 3), {})


def test_a_file_that_the_system_does_not_hand_out_is_a_fault_of_the_model(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(tmp_path / "waves.safetensors")

    def refuse(_: Path) -> None:
        raise PermissionError(errno.EACCES, "Permission denied", str(path))

    monkeypatch.setattr(model_file, "read_dictionary_card", refuse)
    with pytest.raises(ModelError, match=r"waves.safetensors can't be read: Permission denied"):
        load_model(path)


@pytest.mark.parametrize("card", [{"x": float("nan")}, {"x": object()}, {"x": "long" * 100_000}])
def test_a_card_that_could_not_be_read_back_is_not_written(tmp_path: Path, card: dict[str, Any]) -> None:
    with pytest.raises(ModelError):
        save_dictionary(tmp_path / "a.safetensors", Dictionary(some_atoms(), 4, 3), card)
    assert list(tmp_path.iterdir()) == []


def test_shipped_models_are_found_by_name_and_version(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(model_file, "SHIPPED_MODELS", tmp_path)
    for version in (1, 2, 10):
        write(tmp_path / f"waves@{version}.safetensors")
    assert shipped_model("waves").stem == "waves@10"
    assert shipped_model("waves@2").stem == "waves@2"
    for unknown in ("scales", "waves@3", "../waves", "", "wave"):
        with pytest.raises(ModelError, match="waves@1, waves@10, waves@2"):
            shipped_model(unknown)


@pytest.mark.parametrize("path", sorted(SHIPPED_MODELS.glob("*.safetensors")), ids=lambda path: path.stem)
def test_a_shipped_model_loads_and_its_page_tells_whose_work_is_in_it(path: Path) -> None:
    model = load_model(shipped_model(path.stem))
    assert model.path == path
    assert path.stat().st_size < 5_000_000
    assert path.stem == f"{model.card['name']}@{model.card['version']}"
    page = path.with_suffix(".md").read_text("utf-8")
    assert hashlib.sha256(path.read_bytes()).hexdigest() in page
    assert model.card["command"] in page
    assert model.card["training_corpus"]
    for mesh in model.card["training_corpus"] + model.card["held_out"]:
        assert mesh["licence"]
        assert mesh["licence"] in page
    learned_from = {mesh["sha256"] for mesh in model.card["training_corpus"]}
    assert learned_from.isdisjoint(mesh["sha256"] for mesh in model.card["held_out"])


def test_the_general_dictionary_ships() -> None:
    assert shipped_model("general-dictionary@1").is_file()
