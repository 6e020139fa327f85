"""Fills for tests, made without the method, and where real files lie."""

from pathlib import Path

import numpy as np
import pymeshlab

from quadpatch.formats.scan import Fill, Scan
from quadpatch.mesh.weld import weld
from quadpatch.types import IntArray, TriangleMesh

SAMPLES = Path(pymeshlab.__file__).parent / "tests" / "sample_meshes"
INPUTS = Path(__file__).parents[4] / "shared" / "inputs"

EMPTY = Fill(
    np.zeros((0, 3)),
    np.zeros((0, 3), np.int64),
    np.zeros(0, np.int64),
    np.zeros(0),
    np.zeros(0, np.int64),
    np.zeros(0),
)


def as_scan(mesh: TriangleMesh) -> Scan:
    """A mesh that came from no file; its vertices that no triangle uses are dropped."""
    used, corners = np.unique(mesh.triangles, return_inverse=True)
    return Scan(mesh.vertices[used], corners.reshape(-1, 3).astype(np.int64), "memory")


def appended(scan: Scan, fill: Fill) -> bytes:
    """The file of a scan with a fill behind it, whole."""
    assert scan.source is not None
    data = scan.source.append(scan, fill)
    return data if isinstance(data, bytes) else b"".join(data)


def boundary_loops(triangles: IntArray) -> list[list[int]]:
    """Simple loops of directed boundary edges, against the direction of their faces."""
    edges = {(int(a), int(b)) for row in triangles for a, b in ((row[0], row[1]), (row[1], row[2]), (row[2], row[0]))}
    following = {b: a for a, b in edges if (b, a) not in edges}
    loops = []
    while following:
        start, at = following.popitem()
        loop = [start]
        while at != start and at in following:
            loop.append(at)
            at = following.pop(at)
        if at == start and len(loop) > 2:
            loops.append(loop)
    return loops


def cap_holes(scan: Scan) -> Fill:
    """Close every simple boundary loop: a ring of new vertices halfway to the middle, and one in the middle."""
    welded = weld(scan.vertices, scan.triangles)
    vertices: list[np.ndarray] = []
    triangles: list[tuple[int, int, int]] = []
    vertex_hole_id: list[int] = []
    triangle_hole_id: list[int] = []
    for hole, loop in enumerate(boundary_loops(welded.mesh.triangles)):
        rim = [int(i) for i in welded.to_file[loop]]
        ring = [len(scan.vertices) + len(vertices) + i for i in range(len(rim))]
        middle = ring[-1] + 1
        centre = scan.vertices[rim].mean(axis=0)
        vertices += [*(0.5 * (scan.vertices[rim] + centre)), centre]
        for i in range(len(rim)):
            j = (i + 1) % len(rim)
            triangles += [(rim[i], rim[j], ring[i]), (rim[j], ring[j], ring[i]), (ring[i], ring[j], middle)]
        vertex_hole_id += [hole] * (len(rim) + 1)
        triangle_hole_id += [hole] * (3 * len(rim))
    if not triangles:
        return EMPTY
    return Fill(
        np.array(vertices),
        np.array(triangles, dtype=np.int64),
        np.array(vertex_hole_id, dtype=np.int64),
        np.linspace(0.25, 0.75, len(vertices)),
        np.array(triangle_hole_id, dtype=np.int64),
        np.linspace(0.25, 0.75, len(triangles)),
    )


def n_open_edges(scan: Scan) -> int:
    """Boundary edges of a scan once its repeated vertices are joined."""
    triangles = weld(scan.vertices, scan.triangles).mesh.triangles
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    return int((np.unique(edges, axis=0, return_counts=True)[1] == 1).sum())


def cut_hole(scan: Scan, centre: int, n_triangles: int) -> IntArray:
    """Rows of the triangles that are left when the ones nearest to a vertex are cut out, (k,) int64."""
    middles = scan.vertices[scan.triangles].mean(axis=1)
    distance = np.linalg.norm(middles - scan.vertices[centre], axis=1)
    return np.sort(np.argsort(distance, kind="stable")[n_triangles:])
