import numpy as np

from quadpatch.mesh.boundary import boundary_edges
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.measures import surface_area
from quadpatch.types import TriangleMesh
from quadpatch.views.clustering import cells_of, cluster, join
from tests.quadpatch.shapes import bumpy_plate, joined, moved, open_grid, punched, sphere


def clustered(mesh: TriangleMesh, n_triangles: int) -> TriangleMesh:
    vertices, _, triangles, _ = join(mesh, cells_of(mesh, n_triangles), None)
    return TriangleMesh(vertices, triangles)


def test_cells_leave_about_as_many_triangles_as_are_wanted() -> None:
    for mesh, wanted in ((bumpy_plate(300, 4.0), 8000), (sphere(6), 5000)):
        left = clustered(mesh, wanted)
        assert 0.6 * wanted < len(left.triangles) < 1.4 * wanted
        assert distance_to_mesh(left.vertices, mesh).max() < 0.05


def test_one_side_of_a_wall_thinner_than_a_cell_is_left() -> None:
    plate = open_grid(100, 1.0)
    wall = joined(plate, TriangleMesh(moved(plate, (0.0, 0.0, 1e-4)).vertices, plate.triangles[:, ::-1]))
    left = clustered(wall, 4000)
    assert 0.9 < surface_area(left) < 1.1


def test_a_small_fold_vanishes() -> None:
    plate = open_grid(3)
    flap = np.array([[0, 1, 8], [8, 1, 0]])
    mesh = TriangleMesh(plate.vertices, np.concatenate([plate.triangles, flap]))
    _, _, triangles, source = join(mesh, np.arange(9), None)
    assert len(triangles) == len(plate.triangles)
    assert set(source.tolist()) == set(range(8))


def test_vertices_of_the_border_stay_apart_unless_there_are_too_many() -> None:
    mesh = punched(bumpy_plate(120, 4.0), (0.5, 0.5, 0.0), radius=0.3)
    border = np.unique(boundary_edges(mesh.triangles))
    nothing = np.zeros(len(mesh.triangles), bool)
    label = cluster(mesh, 3000, nothing, len(border))
    assert (np.bincount(label)[label[border]] == 1).all()
    assert len(np.unique(label)) < 0.3 * len(label)
    label = cluster(mesh, 3000, nothing, len(border) - 1)
    assert (np.bincount(label)[label[border]] > 1).mean() > 0.5


def test_kept_triangles_keep_their_vertices_also_where_a_file_repeats_them() -> None:
    plate = bumpy_plate(60, 4.0)
    soup = TriangleMesh(plate.vertices[plate.triangles].reshape(-1, 3), np.arange(plate.triangles.size).reshape(-1, 3))
    is_kept = np.arange(len(soup.triangles)) < 50
    label = cluster(soup, 1000, is_kept, 0)
    kept = label[soup.triangles[is_kept]]
    places, first = np.unique(soup.vertices[soup.triangles[is_kept]].reshape(-1, 3), axis=0, return_inverse=True)
    assert len(np.unique(kept)) == len(places)
    assert len(np.unique(np.column_stack([kept.ravel(), first.ravel()]), axis=0)) == len(places)
