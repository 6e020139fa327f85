from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.filling.faults import find_faults
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.rim_relief import relieve_rims
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.normals import triangle_normals
from quadpatch.types import TriangleMesh
from tests.quadpatch.filling.fills import assert_keeps
from tests.quadpatch.filling.handmade import fan, put_together, tent
from tests.quadpatch.shapes import faces_per_edge, is_oriented_manifold, plate_with_disc, random_rotation, sphere

N = 12
PLATE = plate_with_disc(N, 2)
EDGE = 2 * np.sin(np.pi / N)


def with_flat_rim(edges: tuple[int, ...], depth: float) -> FilledMesh:
    """Close a round hole by one vertex, after a triangle all but without height was put at some of its edges.

    The apex of each lies the other way than it should, by `depth`, so its normal points down.
    """
    vertices, triangles, rim = [PLATE.vertices], [PLATE.triangles], []
    for i in range(N):
        rim.append(i)
        if i in edges:
            start, end = PLATE.vertices[i], PLATE.vertices[(i + 1) % N]
            outwards = (start + end) / np.linalg.norm(start + end)
            new = len(PLATE.vertices) + len(vertices) - 1
            vertices.append(((start + end) / 2 + depth * outwards)[None])
            triangles.append(np.array([[i, (i + 1) % N, new]]))
            rim.append(new)
    mesh = TriangleMesh(np.concatenate(vertices), np.concatenate(triangles))
    return put_together(mesh, (np.zeros((1, 3)), fan(np.array(rim))))


def surface(filled: FilledMesh) -> TriangleMesh:
    return TriangleMesh(filled.mesh.vertices, filled.mesh.triangles[filled.n_measured_triangles :])


@pytest.mark.parametrize("edges", [(0,), (3, 7), (0, 1, 2), tuple(range(N))])
@pytest.mark.parametrize("depth", [0.0, 1e-17, 1e-12, 1e-5])
def test_a_rim_without_height_folds_no_more_and_the_surface_hardly_moves(edges: tuple[int, ...], depth: float) -> None:
    before = with_flat_rim(edges, depth)
    n_folds = int(find_faults(before).n_folds[0])
    after = relieve_rims(before)
    assert find_faults(after).n_folds.tolist() == [0]
    assert_keeps(after, TriangleMesh(before.mesh.vertices[:-1], before.mesh.triangles[: before.n_measured_triangles]))
    # One vertex and two triangles more for the two edges of every tip.
    n_more = len(after.mesh.vertices) - len(before.mesh.vertices)
    assert len(after.mesh.triangles) - len(before.mesh.triangles) == 2 * n_more
    if depth >= 1e-12:
        assert n_folds == 2 * n_more == 2 * len(edges)
    new = after.mesh.vertices[len(before.mesh.vertices) :]
    if len(new):
        assert distance_to_mesh(new, surface(before)).max() < 0.02 * EDGE
        assert distance_to_mesh(before.mesh.vertices, surface(after))[-1] == 0.0
    assert is_oriented_manifold(after.mesh.triangles)
    assert (faces_per_edge(after.mesh.triangles) == 1).sum() == N


@given(seed=st.integers(0, 2**32 - 1), size=st.sampled_from([1e-9, 1.0, 1e9]))
@settings(max_examples=10)
def test_rims_are_relieved_in_every_unit_and_place(seed: int, size: float) -> None:
    rng = np.random.default_rng(seed)
    before = with_flat_rim((0, 5), 1e-6)
    vertices = size * (before.mesh.vertices @ random_rotation(rng).T + rng.normal(0, 1, 3))
    placed = replace(before, mesh=TriangleMesh(vertices, before.mesh.triangles))
    assert find_faults(placed).n_folds.tolist() == [4]
    assert find_faults(relieve_rims(placed)).n_folds.tolist() == [0]


def test_strips_are_tilted_no_further_than_they_have_to_be() -> None:
    before = with_flat_rim((0,), 1e-6)
    after = relieve_rims(before)
    normals = triangle_normals(after.mesh.vertices, after.mesh.triangles)
    new = np.flatnonzero(after.invented_triangles)
    assert normals[new][:, 2].min() > np.cos(np.radians(45))


@pytest.mark.parametrize("fill", [tent((0, 0, 0.3)), put_together(sphere(1))])
def test_a_fill_without_such_rims_comes_back_as_it_is(fill: FilledMesh) -> None:
    after = relieve_rims(fill)
    assert after.mesh.vertices.tobytes() == fill.mesh.vertices.tobytes()
    assert after.mesh.triangles.tobytes() == fill.mesh.triangles.tobytes()


def test_folds_of_a_sound_rim_stay() -> None:
    folded = tent((1.03, 0.01, 0.0))
    assert find_faults(relieve_rims(folded)).n_folds.tolist() == find_faults(folded).n_folds.tolist()


@pytest.mark.parametrize("edges", [(0,), (3, 7), tuple(range(N))])
def test_no_piece_touches_the_line_of_a_flat_triangle_in_its_tip_alone(edges: tuple[int, ...]) -> None:
    before = with_flat_rim(edges, 0.0)
    after = relieve_rims(before)
    tips = np.setdiff1d(before.mesh.triangles[: before.n_measured_triangles], PLATE.triangles)
    pieces = after.mesh.triangles[after.n_measured_triangles :]
    at_tips = pieces[np.isin(pieces, tips).any(axis=1)]
    assert len(at_tips) == 2 * len(tips)
    assert np.isin(at_tips, np.arange(N)).any(axis=1).all()
