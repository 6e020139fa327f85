import numpy as np
import pytest

from quadpatch.mesh.normals import area_vectors
from quadpatch.preview.parts import filled_holes, main_pieces, part_of
from quadpatch.types import TriangleMesh


def plane(n: int, side: float = 1.0) -> TriangleMesh:
    x, y = np.meshgrid(np.linspace(0, side, n), np.linspace(0, side, n))
    index = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return TriangleMesh(np.stack([x.ravel(), y.ravel(), np.zeros(n * n)], axis=1), triangles)


def test_a_part_of_many_triangles_is_spoken_for_by_some() -> None:
    mesh = plane(60)
    part = part_of(mesh, np.arange(len(mesh.triangles)))
    assert 400 < len(part.centres) <= 800
    assert len(part.corners) == len(mesh.vertices)
    assert part.diagonal == pytest.approx(np.sqrt(2))


def test_stray_bits_are_no_main_piece() -> None:
    big, bit = plane(20), plane(3, side=0.05)
    both = TriangleMesh(
        np.concatenate([bit.vertices + 50, big.vertices]),
        np.concatenate([bit.triangles, big.triangles + len(bit.vertices)]),
    )
    np.testing.assert_array_equal(main_pieces(both), np.arange(len(bit.triangles), len(both.triangles)))


def test_filled_holes_are_separate_and_the_widest_comes_first() -> None:
    mesh = plane(41)
    centre = mesh.vertices[mesh.triangles].mean(axis=1)
    small = (np.abs(centre[:, :2] - 0.2) < 0.06).all(axis=1)
    large = (np.abs(centre[:, :2] - 0.7) < 0.16).all(axis=1)
    first, second = filled_holes(mesh, small | large, 5)
    np.testing.assert_array_equal(first, np.flatnonzero(large))
    np.testing.assert_array_equal(second, np.flatnonzero(small))
    assert len(filled_holes(mesh, small | large, 1)) == 1


def test_a_bulge_does_not_make_a_hole_larger() -> None:
    mesh = plane(41)
    centre = mesh.vertices[mesh.triangles].mean(axis=1)
    bulging = (np.abs(centre[:, :2] - 0.2) < 0.11).all(axis=1)
    flat = (np.abs(centre[:, :2] - 0.7) < 0.16).all(axis=1)
    vertices = mesh.vertices.copy()
    is_top = (np.abs(vertices[:, :2] - 0.2) < 0.09).all(axis=1)
    vertices[is_top, 2] = 5.0
    bulged = TriangleMesh(vertices, mesh.triangles)
    area = np.linalg.norm(area_vectors(vertices, mesh.triangles), axis=1)
    assert area[bulging].sum() > area[flat].sum()
    np.testing.assert_array_equal(filled_holes(bulged, bulging | flat, 1)[0], np.flatnonzero(flat))


def test_nothing_invented_gives_no_holes() -> None:
    mesh = plane(5)
    assert filled_holes(mesh, np.zeros(len(mesh.triangles), dtype=bool), 3) == []


@pytest.mark.parametrize("count", [1, 99, 101, 300])
def test_of_equal_pieces_all_are_main_pieces(count: int) -> None:
    one = plane(2)
    vertices = np.concatenate([one.vertices + np.array([3.0 * i, 0, 0]) for i in range(count)])
    triangles = np.concatenate([one.triangles + 4 * i for i in range(count)])
    assert len(main_pieces(TriangleMesh(vertices, triangles))) == len(triangles)


def test_pieces_without_area_are_all_main_pieces_and_no_triangles_give_none() -> None:
    flat = TriangleMesh(np.zeros((3, 3)), np.array([[0, 1, 2]]))
    assert main_pieces(flat).tolist() == [0]
    empty = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))
    assert len(main_pieces(empty)) == 0


def test_a_part_of_nothing_has_no_corner_and_no_width() -> None:
    part = part_of(plane(3), np.zeros(0, dtype=np.int64))
    assert part.corners.shape == part.centres.shape == part.area_vectors.shape == (0, 3)
    assert part.diagonal == 0
