"""What a model file says about itself, read without a numeric library.

A network is only recognised here; `jobkit.models.network_header` looks at its parts.
"""

import json
from pathlib import Path
from typing import Literal

from pydantic import ValidationError

from jobkit.errors import UnusableModelError
from quadpatch_client.schema import ModelCard
from quadpatch_rules.dictionary_file import Card, DictionaryFileError, read_dictionary_card

MAX_CARD_BYTES = 64 << 10
# A serialised ONNX ModelProto starts with its first field, ir_version: field 1, a varint.
_ONNX_START = b"\x08"


def artifact_format(path: Path) -> Literal["safetensors", "onnx"]:
    """Return the format of a model file, from its first bytes.

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


def dictionary_card(path: Path) -> Card:
    """Check the header of a dictionary file and return the card in it.

    Raises
    ------
    UnusableModelError
        If the file is no dictionary, see `quadpatch_rules.dictionary_file`.
    """
    try:
        return read_dictionary_card(path)
    except DictionaryFileError as error:
        raise UnusableModelError(str(error)) from error


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
