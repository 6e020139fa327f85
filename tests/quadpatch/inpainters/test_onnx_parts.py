from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.errors import ModelError
from quadpatch.inpainters.model_file import SHIPPED_MODELS
from quadpatch.inpainters.onnx_parts import MAX_DEPTH, check_parts
from tests.quadpatch.inpainters.test_onnx_network import PAPER, write_network


@pytest.fixture(scope="module")
def network(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return write_network(tmp_path_factory.mktemp("network") / "copy.onnx", PAPER, 1).read_bytes()


def refusal(data: bytes) -> str | None:
    """Return the code under which the bytes of a network are refused, None where they are sound."""
    try:
        check_parts(data, "network")
    except ModelError as error:
        return error.code
    return None


@pytest.mark.parametrize("path", sorted(SHIPPED_MODELS.glob("*.onnx")), ids=lambda path: str(path.stem))
def test_networks_that_ship_have_sound_parts(path: Path) -> None:
    assert refusal(path.read_bytes()) is None


def test_a_whole_network_is_sound_and_one_that_is_cut_off_is_refused(network: bytes) -> None:
    assert refusal(network) is None
    assert refusal(network[:-1]) == "unusable_model"


@given(cut=st.integers(1, 2000), flips=st.lists(st.tuples(st.integers(0, 2000), st.integers(0, 255)), max_size=8))
def test_damaged_bytes_are_sound_or_refused_and_nothing_else(
    network: bytes, cut: int, flips: list[tuple[int, int]]
) -> None:
    damaged = bytearray(network)
    for place, byte in flips:
        damaged[place % len(damaged)] = byte
    assert refusal(bytes(damaged[: cut % len(damaged)])) in (None, "unusable_model")


@given(st.binary(max_size=200))
def test_any_bytes_are_sound_or_refused_and_nothing_else(data: bytes) -> None:
    assert refusal(data) in (None, "unusable_model")


def field(number: int, content: bytes) -> bytes:
    """Write a field with a length of up to 28 bits."""
    length, size = len(content), b""
    while length > 127:
        size, length = size + bytes([length & 127 | 128]), length >> 7
    return bytes([number << 3 | 2]) + size + bytes([length]) + content


def test_nesting_ends() -> None:
    graph = b""
    for _ in range(MAX_DEPTH):
        graph = field(1, field(5, field(6, graph)))
    with pytest.raises(ModelError, match="nested"):
        check_parts(field(7, graph), "network")


@pytest.mark.parametrize(("number", "message"), [(20, "training loop"), (25, "functions of its own")])
def test_networks_with_more_than_a_graph_are_refused(number: int, message: str) -> None:
    # Numbers over 15 take two bytes.
    tag = bytes([(number << 3 | 2) & 127 | 128, number >> 4])
    with pytest.raises(ModelError, match=message):
        check_parts(tag + b"\x01\x00", "network")
