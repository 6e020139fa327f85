from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.filling.constrained_fill import fill_constrained
from quadpatch.filling.edge_flips import MOST_TURN_DEG
from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.filling.faults import find_faults
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.refinement import refine
from quadpatch.filling.rim_neighbourhood import RimNeighbourhood
from quadpatch.formats.reading import read_scan
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.intersections import heights
from quadpatch.mesh.normals import triangle_normals, vertex_normals
from quadpatch.types import FloatArray, IntArray, TriangleMesh
from tests.quadpatch.filling.fills import CLOSED, all_loops, assert_keeps
from tests.quadpatch.shapes import is_oriented_manifold, joined, open_grid, punched, sphere

PIZZA = Path(__file__).resolve().parents[4] / "shared" / "bench" / "meshes" / "pizza.ply"


def plate(mesh: TriangleMesh, loops: list[IntArray]) -> FilledMesh:
    return fair_holes(close_holes(mesh, loops), THIN_PLATE)


def constrained(mesh: TriangleMesh, loops: list[IntArray], obstacles: IntArray | None = None) -> FilledMesh:
    return fill_constrained(plate(mesh, loops), loops, np.arange(len(loops)), obstacles)


def invented(filled: FilledMesh) -> TriangleMesh:
    return TriangleMesh(filled.mesh.vertices, filled.mesh.triangles[filled.n_measured_triangles :])


def jagged(seed: int) -> TriangleMesh:
    """A rough sheet with a hole of a random outline, whose plain fills fold and cross more often than not."""
    rng = np.random.default_rng(seed)
    sheet = open_grid(16, 2.0)
    angle = np.arctan2(sheet.vertices[:, 1], sheet.vertices[:, 0])
    reach = 0.45 + 0.25 * np.sin(int(rng.integers(2, 6)) * angle + rng.uniform(0, 6))
    near = np.linalg.norm(sheet.vertices, axis=1) < reach
    bumps = sheet.vertices + np.outer(
        0.5 * np.sin(3 * sheet.vertices[:, 0]) * np.cos(2 * sheet.vertices[:, 1]), [0, 0, 1]
    )
    rough = bumps + rng.normal(0, 0.06, sheet.vertices.shape)
    return TriangleMesh(rough, sheet.triangles[~near[sheet.triangles].any(axis=1)])


@pytest.mark.parametrize("name", list(CLOSED))
def test_where_nothing_is_in_the_way_it_is_about_the_thin_plate(name: str) -> None:
    mesh = CLOSED[name]
    loops = all_loops(mesh)
    filled = constrained(mesh, loops)
    assert_keeps(filled, mesh)
    assert filled.unfilled == []
    assert is_oriented_manifold(filled.mesh.triangles)
    assert not find_faults(filled).is_doubtful.any()
    new, other = invented(filled), invented(plate(mesh, loops))
    distance = distance_to_mesh(new.vertices[new.triangles].mean(axis=1), other)
    edge = np.linalg.norm(np.diff(new.vertices[new.triangles[:, :2]], axis=1), axis=2).mean()
    assert distance.mean() < 0.2 * edge


@given(seed=st.integers(0, 10_000))
@settings(max_examples=6)
def test_nothing_folds_or_crosses_or_the_loop_stays_unfilled(seed: int) -> None:
    mesh = jagged(seed)
    hole = sorted(all_loops(mesh), key=len)[:-1]
    filled = constrained(mesh, hole)
    assert_keeps(filled, mesh)
    faults = find_faults(filled)
    # Folds between three measured corners can't be helped; crossings always can, by another triangulation.
    assert faults.crossings.tolist() == [0] * len(hole)
    for i in range(len(hole)):
        assert (filled.triangle_hole == i).any() != (i in filled.unfilled)


# Every triangulation of the rim of a saddle is another surface.
SADDLE = open_grid(15, 2.0)
SADDLE.vertices[:, 2] = SADDLE.vertices[:, 0] ** 2 - SADDLE.vertices[:, 1] ** 2 + 0.3 * SADDLE.vertices[:, 0]
SADDLE = punched(SADDLE, (0, 0, 0), radius=0.7)


def blade(at: FloatArray) -> TriangleMesh:
    """A small triangle that stands upright at a place of the horizontal."""
    corners = np.array([[-0.011, 0.002, -0.02], [0.012, 0.003, -0.02], [0.001, 0.001, 0.03]])
    return TriangleMesh(at + corners, np.array([[0, 1, 2]]))


@pytest.mark.parametrize("as_obstacle", [True, False])
@pytest.mark.parametrize("n_blades", [1, 2, 3])
def test_blades_in_the_hole_are_gone_around(n_blades: int, as_obstacle: bool) -> None:
    hole = [min(all_loops(SADDLE), key=len)]
    bare, _ = RimNeighbourhood.of(SADDLE, hole).triangulate()
    near = RimNeighbourhood.of(SADDLE, hole)
    centroids = near.vertices[bare.triangles].mean(axis=1) + near.centre
    most_central = centroids[np.argsort(np.linalg.norm(centroids[:, :2], axis=1))[:n_blades]]
    mesh = joined(SADDLE, *(blade(at) for at in most_central))
    n = len(SADDLE.triangles)
    obstacles = mesh.triangles[n:] if as_obstacle else None
    mesh = TriangleMesh(mesh.vertices, mesh.triangles[:n]) if as_obstacle else mesh
    crossed = RimNeighbourhood.of(mesh, hole)
    assert find_faults(crossed.filled(*crossed.triangulate()), obstacles=obstacles).crossings[0] > 0
    filled = constrained(mesh, hole, obstacles)
    assert filled.unfilled == []
    assert_keeps(filled, mesh)
    assert find_faults(filled, obstacles=obstacles).severity.tolist() == [0]


def test_a_rim_whose_every_triangulation_is_crossed_stays_unfilled() -> None:
    # All triangulations of a plane rim are the same surface.
    sheet = punched(open_grid(15, 2.0), (0, 0, 0), radius=0.7)
    mesh = joined(sheet, blade(np.array([0.01, 0.03, 0.0])))
    filled = constrained(mesh, [min(all_loops(sheet), key=len)])
    assert filled.unfilled == [0]
    assert len(filled.triangle_hole) == 0
    assert_keeps(filled, mesh)


def test_fills_keep_clear_of_each_other_and_of_those_that_stay() -> None:
    # Two bent sheets, one above the other, whose fills bulge into each other.
    bowl = open_grid(15, 2.0)
    bowl = TriangleMesh(bowl.vertices + np.outer(0.5 * (bowl.vertices**2).sum(axis=1), [0, 0, 1]), bowl.triangles)
    lower = punched(bowl, (0, 0, 0), radius=0.7)
    upper = TriangleMesh(lower.vertices * [1, 1, -1] + [0.013, 0.007, 0.2], lower.triangles[:, ::-1])
    mesh = joined(TriangleMesh(lower.vertices - [0, 0, 0.1], lower.triangles), upper)
    holes = sorted(all_loops(mesh), key=len)[:2]
    first = plate(mesh, holes)
    assert find_faults(first).crossings.min() > 0
    assert find_faults(fill_constrained(first, holes, np.arange(2))).crossings.tolist() == [0, 0]
    one = fill_constrained(first, holes, np.array([1]))
    assert set(one.triangle_hole.tolist()) == {1}
    assert find_faults(first.with_fills(one, np.array([1]))).crossings.tolist() == [0, 0]


def test_what_lies_far_away_changes_nothing() -> None:
    mesh = jagged(3)
    hole = sorted(all_loops(mesh), key=len)[:1]
    alone = constrained(mesh, hole)
    far = sphere(2)
    together = constrained(joined(mesh, TriangleMesh(far.vertices + 50.0, far.triangles)), hole)
    n, m = alone.n_measured_vertices, together.n_measured_vertices
    assert (alone.mesh.vertices[n:] == together.mesh.vertices[m:]).all()


@pytest.mark.parametrize("seed", range(4))
def test_flips_that_keep_the_rim_in_sight_make_no_sharper_turns(seed: int) -> None:
    mesh = jagged(seed)
    near = RimNeighbourhood.of(mesh, sorted(all_loops(mesh), key=len)[:-1])
    patch, _ = near.triangulate()

    def sharpest_turn(triangles: IntArray, vertices: np.ndarray) -> float:
        every = np.concatenate([triangles, near.adjacent_triangles])
        normals = triangle_normals(vertices, every)
        of_edge: dict[frozenset[int], list[int]] = {}
        for i, (a, b, c) in enumerate(every.tolist()):
            for edge in ((a, b), (b, c), (c, a)):
                of_edge.setdefault(frozenset(edge), []).append(i)
        turns = [
            normals[p] @ normals[q]
            for p, q in (pair for pair in of_edge.values() if len(pair) == 2)
            if min(p, q) < len(triangles)
        ]
        return float(np.degrees(np.arccos(np.clip(min(turns), -1, 1))))

    before = sharpest_turn(patch.triangles, patch.vertices)
    refined = refine(patch, near.edges, near.adjacent_triangles)
    assert sharpest_turn(refined.triangles, refined.vertices) <= max(before, MOST_TURN_DEG) + 1e-6


def test_a_fill_of_a_mesh_in_single_precision_holds_in_a_file_of_single_precision() -> None:
    for seed in range(3):
        mesh = jagged(seed)
        single = TriangleMesh(mesh.vertices.astype(np.float32).astype(np.float64), mesh.triangles)
        filled = constrained(single, sorted(all_loops(mesh), key=len)[:-1])
        assert (filled.mesh.vertices == filled.mesh.vertices.astype(np.float32)).all()


@pytest.mark.parametrize("seed", range(3))
def test_no_triangle_collapses_on_the_way_to_a_first_fill_that_is_crumpled(seed: int) -> None:
    mesh = punched(sphere(3), (0, 0, 1), radius=0.6)
    loops = all_loops(mesh)
    first = plate(mesh, loops)
    new = first.mesh.vertices[first.n_measured_vertices :]
    # Many of its vertices lie in one place.
    rng = np.random.default_rng(seed)
    crumpled = first.with_vertices(np.where(rng.random((len(new), 1)) < 0.5, new, new.mean(axis=0)))
    filled = fill_constrained(crumpled, loops, np.arange(len(loops)))
    assert not find_faults(filled).is_doubtful.any()
    low = heights(filled.mesh.vertices, filled.mesh.triangles[filled.n_measured_triangles :])
    assert low.min() > 0.01


def tongue(turn: float, width: int = 4, size: int = 4) -> TriangleMesh:
    """A sheet with a square hole, into which a tongue of surface reaches that is bent up by `turn` degrees."""
    sheet = open_grid(17)
    start, centroids = -5.0, sheet.vertices[sheet.triangles].mean(axis=1)
    in_hole = (np.abs(centroids[:, :2]) < -start).all(axis=1)
    is_tongue = (np.abs(centroids[:, 1]) < width / 2) & (centroids[:, 0] < start + size)
    x, y, _ = sheet.vertices.T
    bent = (np.abs(y) <= width / 2) & (x > start) & (x <= start + size)
    vertices, curvature = sheet.vertices.copy(), np.radians(turn) / size
    vertices[bent, 0] = start + np.sin(curvature * (x[bent] - start)) / curvature
    vertices[bent, 2] = (1 - np.cos(curvature * (x[bent] - start))) / curvature
    return TriangleMesh(vertices, sheet.triangles[~in_hole | is_tongue])


@pytest.mark.parametrize("turn", [120, 150, 200, 240])
def test_a_hole_with_a_tongue_bent_up_is_filled_as_densely_as_others(turn: float) -> None:
    mesh = tongue(turn)
    loops = sorted(all_loops(mesh), key=len)[:-1]
    assert find_faults(plate(mesh, loops)).is_wrong.all()
    filled = constrained(mesh, loops)
    assert_keeps(filled, mesh)
    assert not find_faults(filled).is_doubtful.any()
    assert len(filled.vertex_hole) > len(mesh.vertices) - len(np.unique(mesh.triangles))


@pytest.mark.skipif(not PIZZA.is_file(), reason="there is no ../shared/bench/meshes/pizza.ply beside this repository")
def test_a_fill_that_folds_back_at_an_overhang_is_turned_outwards() -> None:
    scan = read_scan(PIZZA)
    truth = TriangleMesh(scan.vertices, scan.triangles)
    centre, radius = np.array([0.37534, -0.01686, 0.09907]), 0.035
    normals = vertex_normals(truth.vertices, truth.triangles)
    distance = np.linalg.norm(truth.vertices - centre, axis=1)
    removed = (distance < radius) & (normals @ normals[distance.argmin()] > 0)
    mesh = TriangleMesh(truth.vertices, truth.triangles[~removed[truth.triangles].any(axis=1)])
    loops = [loop for loop in all_loops(mesh) if np.linalg.norm(mesh.vertices[loop] - centre, axis=1).max() < 0.06]
    assert find_faults(plate(mesh, loops)).is_wrong.any()
    filled = constrained(mesh, loops)
    assert not find_faults(filled).is_wrong.any()
    new = invented(filled)
    assert distance_to_mesh(new.vertices[filled.n_measured_vertices :], truth).mean() < 0.04 * radius
