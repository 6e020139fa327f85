import numpy as np

from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.rims import apex_of_edges, rims_of
from quadpatch.types import TriangleMesh, Triangles
from tests.quadpatch.shapes import joined, moved, open_grid

SQUARE = TriangleMesh(np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))


def test_the_rim_of_a_square_has_its_lengths_heights_and_ways_inward() -> None:
    rims = rims_of(SQUARE, [np.array([0, 1, 2, 3])])
    assert rims.points.tolist() == SQUARE.vertices.tolist()
    assert rims.edges.tolist() == [[2, 0, 0], [0, 2, 0], [-2, 0, 0], [0, -2, 0]]
    assert rims.lengths.tolist() == rims.heights.tolist() == [2, 2, 2, 2]
    assert rims.inward.tolist() == [[0, 1, 0], [-1, 0, 0], [0, -1, 0], [1, 0, 0]]


def test_loops_lie_end_to_end_and_are_summed_apart() -> None:
    two = joined(open_grid(4), moved(open_grid(6), (9.0, 0, 0)))
    loops = boundary_loops(two.triangles).loops
    rims = rims_of(two, loops)
    assert rims.n_loops == 2
    assert rims.starts.tolist() == [0, len(loops[0]), len(loops[0]) + len(loops[1])]
    np.testing.assert_allclose(rims.sums(rims.lengths), [rims.lengths[rims.slice_of(k)].sum() for k in (0, 1)])
    # The edges of a closed loop sum to nothing.
    np.testing.assert_allclose(rims.sums(rims.edges), 0, atol=1e-12)


def test_the_apex_is_the_third_corner_and_none_where_no_face_passes() -> None:
    triangles: Triangles = SQUARE.triangles
    assert apex_of_edges(triangles, np.array([0, 1, 2, 1]), np.array([1, 2, 0, 0]), 4).tolist() == [2, 0, 1, -1]
