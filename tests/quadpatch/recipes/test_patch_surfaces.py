from dataclasses import dataclass

import numpy as np
import pytest

from quadpatch.calibration.calibration_set import CalibrationSet, cut_calibration_set
from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.region import Region, region_around
from quadpatch.inpainters.dictionary import SelfDictionary
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.measures import edge_statistics
from quadpatch.options import PatchOptions, RepairOptions
from quadpatch.recipes.default import inpaint
from quadpatch.recipes.patch_surfaces import CoarseCopy, PatchSurface, PatchSurfaces
from quadpatch.types import Vertices
from tests.quadpatch.shapes import on_surface, punched, relief

TRUTH = relief(200, 2.0, 0.02, 8)
PLACES = on_surface(TRUTH, (0.3, 0.2), (-0.5, 0.5), (-0.4, -0.4))
SCAN = punched(TRUTH, *PLACES, radius=0.12)
EDGES = edge_statistics(SCAN)
CELL = 3 * EDGES.mean


@dataclass(frozen=True)
class Fills:
    """A region of the scan, with fills of its holes and of calibration holes."""

    region: Region
    filled: FilledMesh
    holes: CalibrationSet
    calibration: FilledMesh

    def coarse(self) -> PatchSurfaces:
        copy = CoarseCopy(self.region, Region.all_of(SCAN), CELL)
        return copy.surfaces(self.filled, self.holes.removed, self.calibration)


@pytest.fixture(scope="module")
def fills() -> Fills:
    # A corner of the scan is outside of the region.
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("quadpatch.filling.region.MOST_OF_MESH", 1.0)
        region = region_around(SCAN, EDGES, np.array([[-0.2, -0.2, 0.0]]), np.array([1.1]), None)
    assert len(region.mesh.triangles) < 0.95 * len(SCAN.triangles)
    rims = [loop for loop in boundary_loops(region.mesh.triangles).loops if len(loop) < 100]
    filled = fair_holes(close_holes(region.mesh, rims), THIN_PLATE)
    holes = cut_calibration_set(region.mesh, 0.2, EDGES.mean, np.random.default_rng(0))
    assert holes is not None
    calibration = fair_holes(close_holes(holes.closed.mesh, holes.loops), THIN_PLATE)
    return Fills(region, filled, holes, calibration)


def new_vertices(filled: FilledMesh) -> Vertices:
    return filled.mesh.vertices[filled.n_measured_vertices :]


def centroids(surface: PatchSurface) -> Vertices:
    return np.asarray(surface.mesh.vertices[surface.mesh.triangles].mean(axis=1))


def is_near(points: Vertices, places: Vertices) -> "np.ndarray[tuple[int], np.dtype[np.bool_]]":
    """Whether points lie within two cells of some places."""
    return np.asarray(np.linalg.norm(points[:, None] - places, axis=2).min(axis=1) < 2 * CELL)


def test_a_coarse_copy_has_the_edges_that_were_asked_for_and_lies_on_the_scan(fills: Fills) -> None:
    surfaces = fills.coarse()
    assert surfaces.calibration is not None
    for surface, fill in ((surfaces.filled, fills.filled), (surfaces.calibration, fills.calibration)):
        assert surface.edge_length == pytest.approx(CELL, rel=0.15)
        assert len(surface.mesh.triangles) < len(SCAN.triangles) / 6
        distance = distance_to_mesh(centroids(surface)[surface.invented], fill.mesh)
        assert distance.max() < 0.2 * CELL
        assert distance_to_mesh(centroids(surface)[~surface.invented], TRUTH).max() < 0.2 * CELL


def test_what_is_invented_or_cut_away_is_known_of_every_coarse_triangle(fills: Fills) -> None:
    surfaces = fills.coarse()
    real, calibration = surfaces.filled, surfaces.calibration
    assert calibration is not None
    centres = np.array(PLACES)
    in_hole = np.linalg.norm(centroids(real)[:, None] - centres, axis=2).min(axis=1) < 0.1
    assert real.invented[in_hole].all()
    assert is_near(centroids(real)[real.invented], new_vertices(fills.filled)).all()
    assert real.cut_away.any()
    assert is_near(centroids(real)[real.cut_away], fills.holes.removed_vertices).all()
    assert not (real.cut_away & real.invented).any()
    assert calibration.invented.any()
    assert is_near(centroids(calibration)[calibration.invented], new_vertices(fills.calibration)).all()
    # Real holes are open in it, as they are in the mesh that calibration holes were cut into.
    still_there = np.linalg.norm(centroids(calibration)[:, None] - centres, axis=2).min(axis=1) < 0.1
    assert not still_there.any()
    assert not calibration.cut_away.any()


def test_both_copies_are_the_same_where_neither_was_filled(fills: Fills) -> None:
    surfaces = fills.coarse()
    assert surfaces.calibration is not None
    real, calibration = surfaces.filled, surfaces.calibration
    plain = real.mesh.vertices[real.mesh.triangles[~(real.invented | real.cut_away)]]
    other = calibration.mesh.vertices[calibration.mesh.triangles[~calibration.invented]]
    assert {row.tobytes() for row in plain} == {row.tobytes() for row in other}
    assert len(real.undamaged.triangles) == len(plain)


def test_the_scan_itself_is_taken_as_it_is(fills: Fills) -> None:
    surfaces = PatchSurfaces.of_scan(fills.filled, fills.holes.cut_away, fills.calibration, EDGES.mean)
    assert surfaces.filled.mesh is fills.filled.mesh
    assert (
        surfaces.filled.undamaged.triangles.tobytes()
        == fills.holes.closed.mesh.triangles[: len(surfaces.filled.undamaged.triangles)].tobytes()
    )
    assert surfaces.calibration is not None
    assert surfaces.calibration.mesh is fills.calibration.mesh
    assert PatchSurfaces.of_scan(fills.filled, None, None, EDGES.mean).calibration is None


@pytest.mark.slow
def test_a_relief_is_learned_as_well_from_a_coarse_copy(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = relief(200, 2.0, 0.02, 14)
    scan = punched(whole, *[(x, y, 0.0) for x in (-0.5, 0.1, 0.55) for y in (-0.45, 0.05, 0.5)], radius=0.09)
    options = RepairOptions(patches=PatchOptions(resolution=16))
    errors = []
    for least in (1.5, np.inf):
        monkeypatch.setattr("quadpatch.patches.scale._LEAST_COARSENING", least)
        repair = inpaint(scan, SelfDictionary(), options)
        assert repair.completion is not None
        assert repair.completion.blend_factor > 0
        errors.append(distance_to_mesh(new_vertices(repair.filled), whole).mean())
    smooth = distance_to_mesh(new_vertices(inpaint(scan, None, options).filled), whole).mean()
    assert errors[0] < 1.2 * errors[1]
    assert errors[0] < 0.8 * smooth
