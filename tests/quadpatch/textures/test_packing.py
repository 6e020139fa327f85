import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.textures.packing import pack


@given(st.lists(st.tuples(st.integers(1, 60), st.integers(1, 60)), min_size=1, max_size=40))
def test_rectangles_lie_in_the_page_and_apart(sizes: list[tuple[int, int]]) -> None:
    table = np.array(sizes)
    packed = pack(table, 4096)
    assert packed is not None
    page = np.zeros((packed.height, packed.width), np.int64)
    for (x, y), (wide, high) in zip(packed.corners.tolist(), sizes, strict=True):
        assert x + wide <= packed.width
        assert y + high <= packed.height
        page[y : y + high, x : x + wide] += 1
    assert page.max() == 1
    assert all(side & (side - 1) == 0 for side in (packed.width, packed.height))


def test_a_page_is_as_small_as_shelves_allow() -> None:
    packed = pack(np.array([[16, 16]] * 16), 4096)
    assert packed is not None
    assert (packed.width, packed.height) == (64, 64)


def test_what_does_not_fit_is_not_packed() -> None:
    assert pack(np.array([[65, 1]]), 64) is None
    assert pack(np.array([[64, 40], [64, 40]]), 64) is None
