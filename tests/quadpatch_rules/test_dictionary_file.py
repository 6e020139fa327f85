import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from quadpatch_rules.dictionary_file import DictionaryFileError, read_dictionary_card

CARD = {"kind": "dictionary", "patch_resolution": 2}
ATOMS = {"dtype": "F32", "shape": [4, 3], "data_offsets": [0, 48]}


def dictionary_file(atoms: Any = ATOMS, card: Any = CARD, n_data_bytes: int = 48, **tensors: Any) -> bytes:
    text = card if isinstance(card, str) else json.dumps(card)
    header = json.dumps({"__metadata__": {"card": text}, "atoms": atoms, **tensors}).encode()
    return len(header).to_bytes(8, "little") + header + b"\0" * n_data_bytes


def test_the_file_of_this_helper_is_read(tmp_path: Path) -> None:
    path = tmp_path / "model"
    path.write_bytes(dictionary_file())
    assert read_dictionary_card(path) == CARD


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (dictionary_file(card="no JSON"), "no JSON"),
        (dictionary_file(card=[1]), "no JSON object"),
        (dictionary_file(card={**CARD, "kind": "autoencoder"}), "not 'dictionary'"),
        (dictionary_file(card={**CARD, "patch_resolution": 3}), "the card says 3 x 3"),
        (dictionary_file(card='{"kind": "dictionary", "patch_resolution": NaN}'), "NaN"),
        (dictionary_file(atoms={**ATOMS, "dtype": "I64"}), "F32 or F64"),
        (dictionary_file(atoms={**ATOMS, "shape": [4, 3, 1]}), "matrix"),
        (dictionary_file(atoms={**ATOMS, "shape": [True, 3]}), "matrix"),
        (dictionary_file(atoms={**ATOMS, "shape": [4, 2**40]}), "do not fill"),
        (dictionary_file(n_data_bytes=47), "do not fill"),
        (dictionary_file(n_data_bytes=49), "do not fill"),
        (dictionary_file(extra=ATOMS), "alone"),
        (b"\xff" * 8 + b"{" + b"}" * 100, "limit"),
        (b"\x02" + b"\0" * 7 + b"{}", "no card"),
        (b"\x01" + b"\0" * 7 + b"{}", "no JSON"),
        (b"", "header"),
    ],
)
def test_a_broken_dictionary_is_refused_with_the_reason(tmp_path: Path, data: bytes, reason: str) -> None:
    path = tmp_path / "model"
    path.write_bytes(data)
    with pytest.raises(DictionaryFileError, match=reason):
        read_dictionary_card(path)


def test_deeply_nested_json_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "model"
    header = b"[" * 100_000
    path.write_bytes(len(header).to_bytes(8, "little") + header)
    with pytest.raises(DictionaryFileError):
        read_dictionary_card(path)


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(position=st.integers(0, 200), byte=st.integers(0, 255))
@example(position=0, byte=0)
@example(position=7, byte=0)
def test_no_single_byte_crashes_the_reader(
    tmp_path: Path, dictionary_bytes: Callable[[int], bytes], position: int, byte: int
) -> None:
    whole = dictionary_bytes(1)
    data = bytearray(whole)
    data[position] = byte
    path = tmp_path / "model"
    path.write_bytes(bytes(data))
    try:
        card = read_dictionary_card(path)
    except DictionaryFileError:
        # The second example leaves the file as it was: the highest byte of the header's length is 0.
        assert data != whole
        return
    assert card["kind"] == "dictionary"
