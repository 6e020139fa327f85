"""What a dictionary file says about itself, read without a numeric library.

A safetensors file is 8 bytes of length (little endian), a JSON header of that length, and the tensors' bytes. Only the
header is read: the metadata entry `card`, a JSON object, and the shape of the one tensor, `atoms` (n_bins, n_atoms).
"""

import math
from pathlib import Path
from typing import Any, TypeGuard

from quadpatch_rules.strict_json import StrictJsonError, read_json

MAX_HEADER_BYTES = 1 << 20
MAX_FILE_BYTES = 256 << 20
_DTYPE_BYTES = {"F32": 4, "F64": 8}

Card = dict[str, Any]


class DictionaryFileError(ValueError):
    """The file is no dictionary; the message says why, in one line."""


def read_dictionary_card(path: Path) -> Card:
    """Check the header of a dictionary file and return the card in it.

    Raises
    ------
    DictionaryFileError
        If the header is broken or too large, or does not describe one matrix `atoms` that fits the card.
    OSError
        If the file can't be read.
    """
    size = path.stat().st_size
    if size > MAX_FILE_BYTES:
        raise DictionaryFileError(f"the dictionary has {size} bytes; the limit is {MAX_FILE_BYTES}")
    with path.open("rb") as file:
        header_bytes = int.from_bytes(file.read(8), "little")
        if header_bytes > min(MAX_HEADER_BYTES, size - 8):
            raise DictionaryFileError(
                f"the file claims a header of {header_bytes} bytes; the limit is {MAX_HEADER_BYTES}"
            )
        header = _json_object(file.read(header_bytes), "the header")
    metadata = header.pop("__metadata__", None)
    text = metadata.get("card") if isinstance(metadata, dict) else None
    if not isinstance(text, str):
        raise DictionaryFileError("the file has no card in its metadata")
    card = _json_object(text, "the card")
    if card.get("kind") != "dictionary":
        raise DictionaryFileError(f"the card's kind is {card.get('kind')!r}, not 'dictionary'")
    _check_atoms(header, card, size - 8 - header_bytes)
    return card


def _json_object(data: bytes | str, what: str) -> dict[str, Any]:
    try:
        value = read_json(data)
    except StrictJsonError as error:
        raise DictionaryFileError(f"{what} is no JSON: {error}") from error
    if not isinstance(value, dict):
        raise DictionaryFileError(f"{what} is no JSON object")
    return value


def _check_atoms(tensors: dict[str, Any], card: Card, n_data_bytes: int) -> None:
    atoms = tensors.get("atoms")
    if list(tensors) != ["atoms"] or not isinstance(atoms, dict):
        raise DictionaryFileError(f"the file must hold the tensor 'atoms' alone; it holds {list(tensors)[:5]}")
    shape: Any = atoms.get("shape")
    item_bytes = _DTYPE_BYTES.get(str(atoms.get("dtype")))
    if item_bytes is None or not _is_matrix(shape):
        raise DictionaryFileError(f"atoms must be a matrix of F32 or F64; it is {atoms.get('dtype')} {shape}")
    if atoms.get("data_offsets") != [0, n_data_bytes] or math.prod(shape) * item_bytes != n_data_bytes:
        raise DictionaryFileError(f"atoms of shape {shape} do not fill the {n_data_bytes} bytes that follow the header")
    resolution = card.get("patch_resolution")
    if not isinstance(resolution, int) or shape[0] != resolution * resolution:
        raise DictionaryFileError(f"atoms have {shape[0]} bins; the card says {resolution} x {resolution}")


def _is_matrix(shape: Any) -> TypeGuard[list[int]]:
    return isinstance(shape, list) and len(shape) == 2 and all(type(side) is int and side >= 1 for side in shape)
