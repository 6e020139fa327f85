"""Also tests `quadpatch_client.schema.models`."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jobkit.errors import UnusableModelError
from jobkit.models.header import artifact_format, to_wire_card


def test_formats_are_told_by_their_first_bytes(tmp_path: Path, dictionary_bytes: Callable[[int], bytes]) -> None:
    path = tmp_path / "model"
    for data, expected in ((dictionary_bytes(1), "safetensors"), (b"\x08\x0a", "onnx")):
        path.write_bytes(data)
        assert artifact_format(path) == expected
    path.write_bytes(b"PK\x03\x04")
    with pytest.raises(UnusableModelError, match="neither"):
        artifact_format(path)


def test_a_fact_of_the_wrong_type_is_named() -> None:
    with pytest.raises(UnusableModelError, match="n_atoms"):
        to_wire_card({"n_atoms": "many"})
