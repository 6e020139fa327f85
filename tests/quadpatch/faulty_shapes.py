"""Meshes with the faults of real scans: rims that are long or wind, slivers, islands and flaps."""

import numpy as np

from quadpatch.mesh.boundary import boundary_loops
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles, Vertices
from tests.quadpatch.shapes import joined, open_grid, punched


def grown(
    mesh: TriangleMesh, vertices: Vertices | list[list[float]], triangles: Triangles | list[list[int]]
) -> TriangleMesh:
    """Append vertices (k, 3) and triangles (l, 3); corners from -1 downwards count the new vertices."""
    new = np.array(vertices, np.float64).reshape(-1, 3)
    rows = np.array(triangles, np.int64).reshape(-1, 3)
    rows = np.where(rows < 0, len(mesh.vertices) - 1 - rows, rows)
    return TriangleMesh(np.concatenate([mesh.vertices, new]), np.concatenate([mesh.triangles, rows]))


def rim_edges(triangles: Triangles) -> IntArray:
    """Find the corners (n, 3) of the triangles at rims: the rim edge's start and end, and the corner opposite."""
    corners = np.concatenate([triangles, np.roll(triangles, -1, axis=1), np.roll(triangles, 1, axis=1)])
    _, edge, count = np.unique(np.sort(corners[:, :2], axis=1), axis=0, return_inverse=True, return_counts=True)
    return np.asarray(corners[count[edge.ravel()] == 1])


def sheet_with_round_hole(radius: float, bend: float = 0.0) -> TriangleMesh:
    """Build a square sheet, one unit between vertices, with a round hole of ragged rim.

    Parameters
    ----------
    radius : float
        Of the hole; the sheet reaches four units beyond it.
    bend : float
        Radius of a sphere on which the sheet lies; 0 for gentle waves over a plane.
    """
    flat = punched(open_grid(2 * round(radius) + 9), (0, 0, 0), radius=radius)
    x, y, _ = flat.vertices.T
    z = np.sqrt(bend**2 - x**2 - y**2) if bend else 0.05 * radius * np.sin(2 * x / radius) * np.cos(3 * y / radius)
    return TriangleMesh(np.stack([x, y, z], axis=1), flat.triangles)


def sheet_with_crack(n: int) -> TriangleMesh:
    """Build a wavy strip, n vertices long, with a crack along it that is one or two cells wide."""
    long, wide = np.arange(n, dtype=np.float64), 15
    x, y = (part.ravel() for part in np.meshgrid(long, np.arange(wide, dtype=np.float64), indexing="ij"))
    index = np.arange(n * wide).reshape(n, wide)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    vertices = np.stack([x, y, np.sin(0.2 * x) * np.cos(0.3 * y)], axis=1)
    middle = vertices[triangles].mean(axis=1)
    is_far = np.abs(middle[:, 1] - 7 - 2.5 * np.sin(0.15 * middle[:, 0])) > 0.8
    is_end = (middle[:, 0] < 4) | (middle[:, 0] > n - 5)
    return TriangleMesh(vertices, triangles[is_far | is_end])


def sheet_with_spiral(n: int = 41, n_turns: int = 3) -> TriangleMesh:
    """Build a flat square of n x n vertices with a spiral gap, one cell wide, between walls of two cells."""
    sheet = open_grid(n)
    is_gap = np.zeros((n - 1, n - 1), dtype=bool)
    low, high = 8, n - 10
    for turn in range(n_turns):
        here, there = low + 3 * turn, high - 3 * turn
        is_gap[here, max(here - 3, low) : there + 1] = True
        is_gap[here : there + 1, there] = True
        is_gap[there, here : there + 1] = True
        is_gap[here + 3 : there + 1, here] = True
    cell = np.arange(len(sheet.triangles)) % (n - 1) ** 2
    return TriangleMesh(sheet.vertices, sheet.triangles[~is_gap.ravel()[cell]])


def with_triangle_at_rim(mesh: TriangleMesh, edge: int, along: float, height: float) -> TriangleMesh:
    """Glue a triangle to a rim edge.

    Parameters
    ----------
    mesh : TriangleMesh
    edge : int
        Position among `rim_edges`.
    along : float
        Where over the edge its tip lies, 0 to 1.
    height : float
        How far the tip lies in the hole, in lengths of the edge; 0 has no area, below 0 it folds back.
    """
    start, end, opposite = rim_edges(mesh.triangles)[edge]
    a, b, c = mesh.vertices[[start, end, opposite]]
    side = b - a
    outwards = a - c - side * ((a - c) @ side) / max(float(side @ side), 1e-300)
    outwards *= np.linalg.norm(side) / max(float(np.linalg.norm(outwards)), 1e-300)
    return grown(mesh, [a + along * side + height * outwards], [[end, start, -1]])


def with_split_rim_edge(mesh: TriangleMesh, edge: int, along: float) -> TriangleMesh:
    """Split a triangle at a rim where its rim edge is divided 0 < `along` < 1: near an end, one half is a needle."""
    start, end, opposite = rim_edges(mesh.triangles)[edge]
    kept = mesh.triangles[~(np.sort(mesh.triangles, axis=1) == np.sort([start, end, opposite])).all(axis=1)]
    middle = (1 - along) * mesh.vertices[start] + along * mesh.vertices[end]
    return grown(TriangleMesh(mesh.vertices, kept), [middle], [[start, -1, opposite], [-1, end, opposite]])


def with_island(
    mesh: TriangleMesh, loop: IntArray, size: float, rise: float = 0.0, *, turned: bool = False
) -> TriangleMesh:
    """Put a loose disc into the hole within a loop.

    Parameters
    ----------
    mesh : TriangleMesh
    loop : (n,) int64
    size : float
        Radius of the disc in relation to that of the hole.
    rise : float
        How far it lies above the hole's plane, in radii of the hole.
    turned : bool
        Whether it faces the other way than the surface around the hole.
    """
    points = mesh.vertices[loop]
    centre, radius = points.mean(axis=0), float(np.linalg.norm(points - points.mean(axis=0), axis=1).mean())
    # The surface lies on the left of its loop, so the loop runs clockwise around the hole.
    normal = -np.cross(points - centre, np.roll(points, -1, axis=0) - centre).sum(axis=0)
    normal /= np.linalg.norm(normal)
    disc = _disc(max(6, len(loop) // 3))
    x = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    x /= np.linalg.norm(x)
    placed = centre + radius * (
        disc.vertices @ np.stack([size * x, size * np.cross(normal, x), normal]) + rise * normal
    )
    return joined(mesh, TriangleMesh(placed, disc.triangles[:, ::-1] if turned else disc.triangles))


def _disc(n_around: int) -> TriangleMesh:
    """Build a flat disc of radius 1 out of a middle vertex and two rings."""
    rings = 1 + np.arange(2 * n_around).reshape(2, n_around)
    angle = 2 * np.pi * np.arange(n_around) / n_around
    circle = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    inner, outer = rings
    triangles = [np.stack([0 * inner, inner, np.roll(inner, -1)], 1)]
    triangles += [
        np.stack([inner, outer, np.roll(outer, -1)], 1),
        np.stack([inner, np.roll(outer, -1), np.roll(inner, -1)], 1),
    ]
    return TriangleMesh(np.concatenate([np.zeros((1, 3)), circle / 2, circle]), np.concatenate(triangles))


def with_flap(mesh: TriangleMesh, loop: IntArray, reach: float, rise: float) -> TriangleMesh:
    """Hang a strip of measured surface at a third of a loop, across the hole or, with a rise, into the air.

    Parameters
    ----------
    mesh : TriangleMesh
    loop : (n,) int64
    reach : float
        How far it reaches towards the middle of the hole: 1 is the middle.
    rise : float
        How far its far edge lies above the hole's plane, in radii of the hole.
    """
    part = loop[: max(3, len(loop) // 3)]
    points = mesh.vertices[loop]
    centre = points.mean(axis=0)
    normal = -np.cross(points - centre, np.roll(points, -1, axis=0) - centre).sum(axis=0)
    normal *= np.linalg.norm(points - centre, axis=1).mean() / np.linalg.norm(normal)
    tips = mesh.vertices[part] + reach * (centre - mesh.vertices[part]) + rise * normal
    n = len(part)
    triangles = []
    for i in range(n - 1):
        here, there = int(part[i]), int(part[i + 1])
        triangles += [[there, here, -1 - i], [there, -1 - i, -2 - i]]
    return grown(mesh, tips, triangles)


def loops_of(mesh: TriangleMesh) -> list[IntArray]:
    """Find all loops, the longest chain of vertices first."""
    return sorted(boundary_loops(mesh.triangles).loops, key=len, reverse=True)


def inner_loop(mesh: TriangleMesh) -> IntArray:
    """Find the loop of the smallest box: in a sheet with one hole, the hole."""
    return min(loops_of(mesh), key=lambda loop: _box(mesh.vertices[loop]))


def _box(points: FloatArray) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))
