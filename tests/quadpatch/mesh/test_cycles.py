import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.mesh.cycles import plain_cycles
from quadpatch.types import IntArray


def edges_of(*cycles: list[int]) -> IntArray:
    pairs = [(start, end) for cycle in cycles for start, end in zip(cycle, [*cycle[1:], cycle[0]], strict=True)]
    return np.array(pairs, np.int64).reshape(-1, 2)


def found(edges: IntArray) -> list[list[int]]:
    return [cycle.tolist() for cycle in plain_cycles(edges).cycles]


@given(st.lists(st.integers(1, 40), max_size=12), st.randoms(use_true_random=False))
def test_cycles_of_any_length_are_walked_from_their_lowest_vertex_on(lengths: list[int], random) -> None:  # type: ignore[no-untyped-def]
    names = random.sample(range(1000), sum(lengths))
    cycles = [[names.pop() for _ in range(length)] for length in lengths]
    edges = edges_of(*cycles)
    random.shuffle(order := list(range(len(edges))))
    turned = [cycle[(at := cycle.index(min(cycle))) :] + cycle[:at] for cycle in cycles]
    assert found(edges[order]) == sorted(turned)


@pytest.mark.parametrize(
    "odd",
    [
        edges_of([5, 6, 7], [7, 8, 9]),
        np.array([[5, 6], [6, 7]]),
        np.array([[5, 6], [6, 7], [7, 5], [8, 6]]),
    ],
)
def test_what_touches_another_chain_or_is_open_is_left(odd: IntArray) -> None:
    plain = edges_of([3, 1, 2])
    result = plain_cycles(np.concatenate([odd, plain]))
    assert [cycle.tolist() for cycle in result.cycles] == [[1, 2, 3]]
    assert result.is_plain.tolist() == [False] * len(odd) + [True] * 3


def test_no_edge_has_no_cycle() -> None:
    assert found(np.zeros((0, 2), np.int64)) == []
