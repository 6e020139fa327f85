import numpy as np
import pytest

from quadpatch.mesh.normals import area_vectors
from quadpatch.preview.invented import SURE, TINT, UNSURE, Invented, confidence_colours, spanned_rims
from quadpatch.preview.shading import CLAY
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import open_grid


def test_measured_surface_is_clay_and_invented_surface_tinted() -> None:
    colours = Invented(np.array([-1, 0, 5])).colours()
    assert colours.tolist() == [CLAY.tolist(), TINT.tolist(), TINT.tolist()]


def test_confidence_runs_from_one_colour_to_another_and_may_be_unknown() -> None:
    colours = confidence_colours(np.array([0.0, 1.0, 0.5, np.nan]))
    assert colours[0] == pytest.approx(UNSURE)
    assert colours[1] == pytest.approx(SURE)
    assert colours[2] == pytest.approx((UNSURE + SURE) / 2)
    assert all(np.abs(colours[3] - other).max() > 0.1 for other in (UNSURE, SURE))
    assert ((colours >= 0) & (colours <= 1)).all()


def test_some_triangles_keep_what_is_known_of_them() -> None:
    some = Invented(np.array([-1, 3, 4]), np.array([np.nan, 0.2, 0.8])).of(np.array([2, 0]))
    assert some.hole.tolist() == [4, -1]
    assert some.mask.tolist() == [True, False]
    assert some.confidence is not None
    assert some.confidence[0] == 0.8


def test_rims_are_spanned_whatever_fills_them() -> None:
    mesh = open_grid(21, 2.0)
    middles = mesh.vertices[mesh.triangles].mean(axis=1)
    invented = np.asarray((np.abs(middles[:, :2] - [0.4, 0.4]) < 0.25).all(axis=1))
    bulged = mesh.vertices.copy()
    bulged[np.setdiff1d(mesh.triangles[invented], mesh.triangles[~invented]), 2] += 0.5
    flat, other = spanned_rims(mesh, invented), spanned_rims(TriangleMesh(bulged, mesh.triangles), invented)
    assert flat.area_vectors == pytest.approx(other.area_vectors)
    # Twice the area, upwards.
    doubled = np.linalg.norm(area_vectors(mesh.vertices, mesh.triangles[invented]), axis=1).sum()
    assert flat.area_vectors.sum(axis=0) == pytest.approx([0.0, 0.0, doubled])


def test_without_holes_nothing_is_spanned() -> None:
    mesh = open_grid(5, 2.0)
    assert len(spanned_rims(mesh, np.zeros(len(mesh.triangles), bool)).corners) == 0
