"""What a model file says about itself, read without a numeric library.

A safetensors file is 8 bytes of length (little endian), a JSON header of that length, and the tensors' bytes. Only the
header is read. A network is only recognised here; `jobkit.models.network_header` looks at its parts.
"""

import json
import math
from pathlib import Path
from typing import Any, Literal, TypeGuard

from pydantic import ValidationError

from jobkit.errors import UnusableModelError
from jobkit.schema import ModelCard
from jobkit.strict_json import StrictJsonError, read_json

MAX_HEADER_BYTES = 1 << 20
MAX_DICTIONARY_BYTES = 256 << 20
MAX_CARD_BYTES = 64 << 10
_DTYPE_BYTES = {"F32": 4, "F64": 8}
# A serialised ONNX ModelProto starts with its first field, ir_version: field 1, a varint.
_ONNX_START = b"\x08"

Card = dict[str, Any]


def artifact_format(path: Path) -> Literal["safetensors", "onnx"]:
    """Tell the format of a model file by its first bytes.

    Raises
    ------
    UnusableModelError
        If it is neither.
    """
    with path.open("rb") as file:
        start = file.read(9)
    if len(start) == 9 and start[8:] == b"{" and int.from_bytes(start[:8], "little") <= path.stat().st_size:
        return "safetensors"
    if start[:1] == _ONNX_START:
        return "onnx"
    raise UnusableModelError("the artifact is neither a safetensors file nor an ONNX network")


def read_dictionary_card(path: Path) -> Card:
    """Check the header of a dictionary file and return the card in it.

    Raises
    ------
    UnusableModelError
        If the header is broken or too large, or does not describe one matrix `atoms` that fits the card.
    """
    size = path.stat().st_size
    if size > MAX_DICTIONARY_BYTES:
        raise UnusableModelError(f"the dictionary has {size} bytes; the limit is {MAX_DICTIONARY_BYTES}")
    with path.open("rb") as file:
        header_bytes = int.from_bytes(file.read(8), "little")
        if header_bytes > min(MAX_HEADER_BYTES, size - 8):
            raise UnusableModelError(
                f"the file claims a header of {header_bytes} bytes; the limit is {MAX_HEADER_BYTES}"
            )
        header = _json_object(file.read(header_bytes), "the header")
    metadata = header.pop("__metadata__", None)
    text = metadata.get("card") if isinstance(metadata, dict) else None
    if not isinstance(text, str):
        raise UnusableModelError("the file has no card in its metadata")
    card = _json_object(text.encode(), "the card")
    if card.get("kind") != "dictionary":
        raise UnusableModelError(f"the card's kind is {card.get('kind')!r}, not 'dictionary'")
    _check_atoms(header, card, size - 8 - header_bytes)
    return card


def to_wire_card(card: Card) -> ModelCard:
    """Return the card as clients see it; facts without a field of their own go into `extra`.

    Raises
    ------
    UnusableModelError
        If a fact is of the wrong type, or the card is no JSON or too large: every list of models shows it.
    """
    try:
        size = len(json.dumps(card, allow_nan=False, ensure_ascii=False).encode())
    except (ValueError, RecursionError) as error:
        raise UnusableModelError("the card holds a number or a text that is not of JSON") from error
    if size > MAX_CARD_BYTES:
        raise UnusableModelError(f"the card has {size} bytes; the limit is {MAX_CARD_BYTES}")
    fields = ModelCard.model_fields.keys() - {"extra"}
    known = {name: value for name, value in card.items() if name in fields and value is not None}
    extra = {name: value for name, value in card.items() if name not in fields | {"kind", "name", "version"}}
    try:
        return ModelCard.model_validate({**known, "extra": extra})
    except ValidationError as error:
        first = error.errors(include_input=False)[0]
        raise UnusableModelError(f"the card's {first['loc'][0]} is wrong: {first['msg']}") from error


def _json_object(data: bytes, what: str) -> dict[str, Any]:
    try:
        value = read_json(data)
    except StrictJsonError as error:
        raise UnusableModelError(f"{what} is no JSON: {error}") from error
    if not isinstance(value, dict):
        raise UnusableModelError(f"{what} is no JSON object")
    return value


def _check_atoms(tensors: dict[str, Any], card: Card, n_data_bytes: int) -> None:
    atoms = tensors.get("atoms")
    if list(tensors) != ["atoms"] or not isinstance(atoms, dict):
        raise UnusableModelError(f"the file must hold the tensor 'atoms' alone; it holds {list(tensors)[:5]}")
    shape: Any = atoms.get("shape")
    item_bytes = _DTYPE_BYTES.get(str(atoms.get("dtype")))
    if item_bytes is None or not _is_matrix(shape):
        raise UnusableModelError(f"atoms must be a matrix of F32 or F64; it is {atoms.get('dtype')} {shape}")
    if atoms.get("data_offsets") != [0, n_data_bytes] or math.prod(shape) * item_bytes != n_data_bytes:
        raise UnusableModelError(f"atoms of shape {shape} do not fill the {n_data_bytes} bytes that follow the header")
    resolution = card.get("patch_resolution")
    if not isinstance(resolution, int) or shape[0] != resolution * resolution:
        raise UnusableModelError(f"atoms have {shape[0]} bins; the card says {resolution} x {resolution}")


def _is_matrix(shape: Any) -> TypeGuard[list[int]]:
    return isinstance(shape, list) and len(shape) == 2 and all(type(side) is int and side >= 1 for side in shape)
