"""Model files: dictionaries as safetensors with their card inside; networks as ONNX.

A dictionary's file holds one tensor, `atoms` (n_bins, n_atoms), and one metadata entry, `card`: a JSON object with
everything one must know about the model (where it comes from, what it is good for, how it codes patches). Nothing
in a model file is ever executed, and every claim of a file is checked before it is used.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import save

from quadpatch.errors import ModelError
from quadpatch.patches.normalisation import HEIGHTS, NORMALISATION
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.types import FloatArray
from quadpatch_rules.dictionary_file import MAX_HEADER_BYTES, Card, DictionaryFileError, read_dictionary_card
from quadpatch_rules.option_words import Recipe

SHIPPED_MODELS = Path(__file__).parent.parent / "shipped_models"
SUFFIXES = (".safetensors", ".onnx")
MAX_RESOLUTION = 128
MAX_ATOMS = 16384
# Files may round atoms to float32, or keep a few digits less; further from 1 they are no atoms.
FILE_NORM_TOLERANCE = 1e-3

# What dictionaries say of their signals, and the recipe that makes such signals.
RECIPES: dict[str, Recipe] = {NORMALISATION: "default", HEIGHTS: "paper"}


@dataclass(frozen=True)
class Model:
    """A model, ready for the inpainter of its kind.

    Attributes
    ----------
    path : Path
        The file it came from.
    kind : str
        `dictionary` or `autoencoder`.
    card : dict
        Empty for a network: its card stands in its own metadata, which the ONNX adapter reads.
    dictionary : Dictionary or None
        None for a network.
    recipe : str
        What it was learned for: `default` or `paper`.
    """

    path: Path
    kind: Literal["dictionary", "autoencoder"]
    card: Card
    dictionary: Dictionary | None
    recipe: Recipe = "default"


def load_model(path: str | Path) -> Model:
    """Read a model file.

    Parameters
    ----------
    path : str or Path
        `.safetensors` for a dictionary; `.onnx` for a network, which is not opened here.

    Raises
    ------
    ModelError
        If there is no such file, its suffix is neither, or what it holds is not a usable dictionary.
    """
    path = Path(path)
    if not path.is_file():
        raise ModelError(f"no model file {path}")
    if path.suffix == ".onnx":
        return Model(path, "autoencoder", {}, None)
    card = model_card(path)
    recipe = RECIPES.get(str(card.get("normalisation")))
    if recipe is None:
        raise ModelError(f"normalisation {card.get('normalisation')!r}; known are {', '.join(map(repr, RECIPES))}")
    resolution = _count(card, "patch_resolution", MAX_RESOLUTION)
    dictionary = Dictionary(_read_atoms(path), resolution, _count(card, "n_nonzero", MAX_ATOMS))
    return Model(path, "dictionary", card, dictionary, recipe)


def save_dictionary(
    path: str | Path, dictionary: Dictionary, card: Mapping[str, Any], normalisation: str = NORMALISATION
) -> None:
    """Write a dictionary and its card; same dictionary and card, same bytes.

    Parameters
    ----------
    path : str or Path
        Ends in `.safetensors`.
    dictionary : Dictionary
        Its atoms are stored as float32 and brought back to unit norm on reading.
    card : mapping
        JSON-ready. What follows from the dictionary itself is added to it.
    normalisation : str
        How the signals that it was learned from were made, one of `RECIPES`.

    Raises
    ------
    ModelError
        If the suffix is another one, or the card is no JSON or too large to be read back.
    """
    path = Path(path)
    if path.suffix != ".safetensors":
        raise ModelError(f"a dictionary is written as .safetensors; got {path.name}")
    whole_card = {
        **card,
        "kind": "dictionary",
        "normalisation": normalisation,
        "patch_resolution": dictionary.resolution,
        "n_atoms": dictionary.n_atoms,
        "n_nonzero": dictionary.n_nonzero,
    }
    try:
        # One entry only: safetensors writes several in random order, and bytes must repeat.
        metadata = {"card": json.dumps(whole_card, sort_keys=True, allow_nan=False, ensure_ascii=False)}
    except (TypeError, ValueError) as error:
        raise ModelError(f"the card is no JSON: {error}") from error
    if len(metadata["card"].encode()) > MAX_HEADER_BYTES // 4:
        raise ModelError(f"the card is larger than {MAX_HEADER_BYTES // 4} bytes")
    path.write_bytes(save({"atoms": np.ascontiguousarray(dictionary.atoms, dtype=np.float32)}, metadata))


def model_card(path: str | Path) -> Card:
    """Read the card of a dictionary file.

    Raises
    ------
    ModelError
        If the file is no dictionary file, or its card is missing or no JSON object.
    """
    path = Path(path)
    if not path.is_file():
        raise ModelError(f"no model file {path}")
    if path.suffix != ".safetensors":
        raise ModelError(f"a model file ends in .safetensors or .onnx; got {path.name}")
    try:
        return read_dictionary_card(path)
    except DictionaryFileError as error:
        raise ModelError(f"{path.name}: {error}") from error
    except OSError as error:
        raise ModelError(f"{path.name} can't be read: {error.strerror}") from error


def shipped_model(name: str) -> Path:
    """Find a model that comes with the project.

    Parameters
    ----------
    name : str
        `name@version`, or `name` alone for its newest version.

    Raises
    ------
    ModelError
        If there is none; the message lists those there are.
    """
    files = sorted(path for path in SHIPPED_MODELS.glob("*@*.*") if path.suffix in SUFFIXES)
    shipped = {path.stem: path for path in files}
    versions = {key: int(key.rpartition("@")[2]) for key in shipped if key.rpartition("@")[2].isdecimal()}
    matching = [key for key in versions if name in (key, key.rpartition("@")[0])]
    if not matching:
        raise ModelError(f"{name!r} is no file and no shipped model; shipped are: {', '.join(versions) or 'none'}")
    return shipped[max(matching, key=lambda key: versions[key])]


def _read_atoms(path: Path) -> FloatArray:
    """Read the atoms and bring them from the file's precision to unit norm."""
    try:
        with safe_open(path, framework="numpy") as file:
            n_atoms = file.get_slice("atoms").get_shape()[1]
            if n_atoms > MAX_ATOMS:
                raise ModelError(f"{path.name} has {n_atoms} atoms; the limit is {MAX_ATOMS}")
            stored = file.get_tensor("atoms")
    except (SafetensorError, OSError) as error:
        raise ModelError(f"{path.name} is no safetensors file: {error}") from error
    # Before any arithmetic: damaged bytes hold values that overflow, and NaNs that can't even be converted in silence.
    is_sane = np.isfinite(stored).all() and (np.abs(stored) <= 1.0 + FILE_NORM_TOLERANCE).all()
    atoms = stored.astype(np.float64) if is_sane else np.zeros_like(stored, np.float64)
    norms = np.linalg.norm(atoms, axis=0)
    if not (np.abs(norms - 1.0) <= FILE_NORM_TOLERANCE).all():
        raise ModelError(f"atoms of {path.name} are not finite columns of unit norm")
    return np.asarray(atoms / norms)


def _count(card: Card, key: str, limit: int) -> int:
    value = card.get(key)
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= limit:
        raise ModelError(f"the card's {key} is {value!r}; it must be a whole number from 1 to {limit}")
    return value
