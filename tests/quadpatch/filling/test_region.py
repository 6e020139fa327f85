import numpy as np
import pytest

from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.filling.region import Region, region_around
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.measures import edge_statistics
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, on_surface, punched

WHOLE = bumpy_plate(120, 2.0)
SHEET = punched(WHOLE, *on_surface(WHOLE, (0.5, 0.4), (-0.6, -0.5)), radius=0.07)
HOLES = sorted(boundary_loops(SHEET.triangles).loops, key=len)[:2]
CENTRES = np.array([SHEET.vertices[loop].mean(axis=0) for loop in HOLES])


def around(radius: float, mesh: TriangleMesh = SHEET) -> Region:
    return region_around(mesh, edge_statistics(mesh), CENTRES, np.full(2, radius), None)


def corners(mesh: TriangleMesh) -> set[bytes]:
    return {triangle.tobytes() for triangle in mesh.vertices[mesh.triangles]}


def test_rows_of_triangles_are_those_of_the_region() -> None:
    region = around(0.2)
    middles = SHEET.vertices[SHEET.triangles].mean(axis=1)
    assert 0 < len(region.mesh.triangles) < len(SHEET.triangles)
    assert (region.of_triangles(middles) == region.mesh.vertices[region.mesh.triangles].mean(axis=1)).all()
    # Of a table of the first triangles, those that the region has come back.
    first = region.of_triangles(np.arange(len(SHEET.triangles) // 2))
    assert 0 < len(first) < len(region.mesh.triangles)
    assert (first == region.of_triangles(np.arange(len(SHEET.triangles)))[: len(first)]).all()
    assert Region.all_of(SHEET).of_triangles(middles) is middles


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.35])
def test_a_region_has_every_triangle_that_comes_near_and_few_others(radius: float) -> None:
    region = around(radius)
    near = [
        i
        for i, triangle in enumerate(SHEET.triangles)
        if (distance_to_mesh(CENTRES, TriangleMesh(SHEET.vertices, triangle[np.newaxis])) < radius).any()
    ]
    wanted = corners(TriangleMesh(SHEET.vertices, SHEET.triangles[near]))
    assert wanted <= corners(region.mesh) <= corners(SHEET)
    assert len(region.mesh.triangles) < 0.5 * len(SHEET.triangles)


def test_the_same_fill_has_the_same_bits_as_on_the_whole_mesh() -> None:
    region = around(0.25)
    local = fair_holes(close_holes(region.mesh, [region.local(loop) for loop in HOLES]), THIN_PLATE)
    whole = fair_holes(close_holes(SHEET, HOLES), THIN_PLATE)
    widened = region.widened(local)
    assert region.mesh is not SHEET
    assert widened.mesh.vertices.tobytes() == whole.mesh.vertices.tobytes()
    assert widened.mesh.triangles.tobytes() == whole.mesh.triangles.tobytes()
    assert widened.measured.triangles.tobytes() == SHEET.triangles.tobytes()


def test_where_most_of_a_mesh_is_near_the_whole_is_taken() -> None:
    region = around(2.0)
    assert region.mesh is SHEET
    filled = fair_holes(close_holes(SHEET, HOLES), THIN_PLATE)
    assert region.widened(filled) is filled


def test_a_long_triangle_belongs_to_every_region() -> None:
    n = len(SHEET.vertices)
    far: FloatArray = np.array([[-30.0, -30.0, 0.3], [30.0, -30.0, 0.3], [0.0, 40.0, 0.3]])
    mesh = TriangleMesh(
        np.concatenate([SHEET.vertices, far]), np.concatenate([SHEET.triangles, np.array([[n, n + 1, n + 2]])])
    )
    region = around(0.1, mesh)
    assert region.mesh is not mesh
    assert far.tobytes() in corners(region.mesh)


def test_obstacles_near_a_hole_are_kept_with_their_vertices() -> None:
    rim = int(HOLES[0][0])
    far_from_all = int(np.linalg.norm(SHEET.vertices - CENTRES[0], axis=1).argmax())
    # The last one runs across the sheet, with no corner near the hole.
    across = [0, 119, 120 * 120 - 1]
    elsewhere = [far_from_all - 121, far_from_all - 122, far_from_all - 241]
    obstacles = np.array([[rim, rim + 1, far_from_all], elsewhere, across])
    region = region_around(SHEET, edge_statistics(SHEET), CENTRES[:1], np.array([0.1]), obstacles)
    local = region.local_triangles(obstacles)
    assert local is not None
    assert region.vertices[local].tolist() == obstacles[[0, 2]].tolist()
