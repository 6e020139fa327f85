import numpy as np
import pytest

from quadpatch.mesh.raycast import RayScene
from quadpatch.preview.camera import Camera, view_of
from quadpatch.preview.invented import TINT, Invented
from quadpatch.preview.pair import filled_pair, moved_pair
from quadpatch.preview.sampling import Colours
from quadpatch.preview.shading import CLAY, Clay
from quadpatch.types import BoolArray, FloatArray, TriangleMesh
from tests.quadpatch.shapes import joined, sphere

SIZE = (90, 70)
TOWARDS = np.array([0.36, 0.48, 0.8])


def balls() -> tuple[TriangleMesh, BoolArray]:
    """A ball in a ball, each with a fill on the side of the viewer, one behind the other."""
    outer = sphere(4)
    inner = TriangleMesh(0.6 * outer.vertices, outer.triangles)
    mesh = joined(outer, inner)
    directions = mesh.vertices[mesh.triangles].mean(axis=1)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return mesh, np.asarray(directions @ TOWARDS > 0.9)


def camera(mesh: TriangleMesh) -> Camera:
    return view_of(mesh.vertices, TOWARDS, SIZE[0] / SIZE[1])


def alone(mesh: TriangleMesh, colours: FloatArray) -> FloatArray:
    return Clay(mesh, RayScene(mesh), colours).draw(camera(mesh), SIZE)


def share_that_differs(one: Colours | FloatArray, other: Colours | FloatArray) -> float:
    return float((np.abs(one - other).max(axis=2) > 2 / 255).mean())


def test_a_pair_is_drawn_like_each_of_its_meshes_alone() -> None:
    after, invented = balls()
    before = TriangleMesh(after.vertices, after.triangles[~invented])
    old, new = filled_pair(after, Invented.of_mask(invented)).draw(camera(after), SIZE)
    expected = alone(before, np.tile(CLAY, (len(before.triangles), 1)))
    # A pixel gets more samples where either picture changes, so a few pixels are smoother.
    assert share_that_differs(old, expected) < 0.01
    assert share_that_differs(new, alone(after, np.where(invented[:, None], TINT, CLAY))) < 0.01
    assert share_that_differs(old, new) > 0.05


def test_a_mesh_that_moved_is_drawn_where_it_was() -> None:
    after = sphere(4)
    before = TriangleMesh(after.vertices * [0.5, 1.2, 0.5], after.triangles)
    old, _ = moved_pair(before, after, np.ones(len(after.triangles))).draw(camera(after), SIZE)
    expected = Clay(before, RayScene(before), np.tile(CLAY, (len(before.triangles), 1))).draw(camera(after), SIZE)
    assert share_that_differs(old, expected) < 0.01


@pytest.mark.parametrize("is_turned", [False, True])
def test_a_pair_is_turned_to_the_outside(is_turned: bool) -> None:
    mesh = sphere(3)
    mesh = TriangleMesh(mesh.vertices, mesh.triangles[:, ::-1]) if is_turned else mesh
    pair = filled_pair(mesh, Invented.of_mask(np.zeros(len(mesh.triangles), dtype=bool)))
    assert pair.is_flipped == is_turned
    outwards = np.einsum("ij,ij->i", pair.whole.centres, pair.whole.area_vectors)
    assert (outwards > 0).all()
