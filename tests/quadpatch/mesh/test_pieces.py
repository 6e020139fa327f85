import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.mesh.pieces import find_pieces
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import joined, open_grid, sphere


@given(sizes=st.lists(st.integers(2, 5), min_size=1, max_size=5), seed=st.integers(0, 2**32 - 1))
@settings(max_examples=20)
def test_every_mesh_of_several_is_a_piece_however_vertices_and_triangles_are_ordered(
    sizes: list[int], seed: int
) -> None:
    whole = joined(*(open_grid(n) for n in sizes))
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(whole.vertices))
    mixed = TriangleMesh(whole.vertices[np.argsort(order)], rng.permutation(order[whole.triangles]))
    expected = np.repeat(np.arange(len(sizes)), [n * n for n in sizes])
    piece = find_pieces(mixed, []).of_vertex[order]
    assert sorted(set(piece.tolist())) == list(range(len(sizes)))
    assert len(set(zip(piece.tolist(), expected.tolist(), strict=True))) == len(sizes)


def test_a_vertex_in_common_connects_and_a_vertex_without_triangles_is_a_piece_of_its_own() -> None:
    triangles = np.array([[0, 1, 2], [2, 3, 4]])
    assert find_pieces(TriangleMesh(np.zeros((6, 3)), triangles), []).of_vertex.tolist() == [0, 0, 0, 0, 0, 1]


def test_a_mesh_without_triangles_has_as_many_pieces_as_vertices() -> None:
    assert find_pieces(TriangleMesh(np.zeros((3, 3)), np.zeros((0, 3), np.int64)), []).of_vertex.tolist() == [0, 1, 2]
    assert find_pieces(TriangleMesh(sphere(0).vertices, sphere(0).triangles), []).of_vertex.tolist() == [0] * 12
