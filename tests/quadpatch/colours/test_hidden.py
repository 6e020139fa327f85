import numpy as np

from quadpatch.colours.hidden import hide_disks
from quadpatch.mesh.loop_diameter import loop_diameter
from quadpatch.mesh.topology import components, directed_edges
from quadpatch.types import IntArray, TriangleMesh
from tests.quadpatch.shapes import open_grid

MESH = open_grid(101)
GAP = np.where(np.linalg.norm(MESH.vertices[:, :2] - (20.0, 10.0), axis=1) < 5.0, 0, -1)


def hidden(mesh: TriangleMesh = MESH, gap: IntArray = GAP) -> IntArray:
    return hide_disks(mesh, gap, 1, 1.0, np.random.default_rng(0))


def test_real_gaps_keep_their_number_and_disks_have_the_next_ones() -> None:
    found = hidden()
    assert (found[GAP == 0] == 0).all()
    assert set(np.unique(found)) == set(range(-1, found.max() + 1))
    assert 16 <= found.max() <= 24


def test_disks_are_connected_and_apart_from_each_other_and_from_the_gaps() -> None:
    found = hidden()
    edges = directed_edges(MESH.triangles)
    inside = edges[(found[edges] >= 0).all(axis=1)]
    assert (found[inside[:, 0]] == found[inside[:, 1]]).all()
    piece = components(inside, len(found))
    for number in range(found.max() + 1):
        assert len(np.unique(piece[found == number])) == 1


def test_disks_are_about_as_wide_as_the_gaps() -> None:
    found = hidden()
    widths = [loop_diameter(MESH.vertices[found == number]) for number in range(1, found.max() + 1)]
    assert 7 < np.median(widths) < 11


def test_no_disk_reaches_the_border() -> None:
    assert np.abs(MESH.vertices[hidden() >= 0]).max() < 48


def test_a_surface_without_room_gets_no_disks() -> None:
    small = open_grid(13)
    gap = np.where(np.linalg.norm(small.vertices, axis=1) < 3.0, 0, -1)
    assert (hidden(small, gap) == gap).all()
