import numpy as np
import onnxruntime as ort
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.errors import ModelError
from quadpatch.inpainters.model_file import shipped_model
from quadpatch.inpainters.onnx_filters import first_filters
from tests.quadpatch.inpainters.test_onnx_parts import field


@pytest.mark.parametrize(("name", "shape"), [("general-small_4x", (32, 1, 3, 3)), ("general-residual", (32, 2, 6, 6))])
def test_filters_of_shipped_networks_are_those_of_their_file(name: str, shape: tuple[int, ...]) -> None:
    data = shipped_model(name).read_bytes()
    filters = first_filters(data, name)
    assert filters.shape == shape
    assert np.float32(filters).tobytes() in data
    assert len(ort.InferenceSession(data).get_inputs()[0].shape) == 4


def network(shape: bytes, numbers: bytes, kind: int = 1) -> bytes:
    node = field(1, b"x") + field(1, b"w") + field(4, b"Conv")
    tensor = shape + b"\x10" + bytes([kind]) + field(8, b"w") + field(9, numbers)
    return field(7, field(1, node) + field(5, tensor))


PACKED = field(1, bytes([200, 1, 1, 1, 1]))


def test_sizes_are_read_packed_and_one_by_one() -> None:
    numbers = np.arange(200, dtype="<f4")
    one_by_one = bytes([8, 200, 1, 8, 1, 8, 1, 8, 1])
    for shape in (PACKED, one_by_one):
        assert first_filters(network(shape, numbers.tobytes()), "n")[:, 0, 0, 0].tolist() == numbers.tolist()


@pytest.mark.parametrize(
    "data",
    [
        network(PACKED, b"\0" * 799),
        network(PACKED, b"\0" * 800, kind=3),
        network(PACKED, np.full(200, np.nan, "<f4").tobytes()),
        network(field(1, bytes([200, 1, 1])), b"\0" * 800),
        field(7, b""),
        b"",
    ],
    ids=["too short", "bytes", "no numbers", "two axes", "no nodes", "nothing"],
)
def test_what_can_not_be_drawn_is_refused(data: bytes) -> None:
    with pytest.raises(ModelError):
        first_filters(data, "n")


@given(data=st.binary(max_size=64))
def test_any_bytes_are_read_or_refused(data: bytes) -> None:
    for tried in (data, field(7, field(5, data))):
        with pytest.raises(ModelError):
            first_filters(tried, "n")
