"""Filled meshes that are put together by hand, so that their faults are known."""

import numpy as np

from quadpatch.filling.checked_fill import LoopsToFill
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.types import FloatArray, IntArray, TriangleMesh
from tests.quadpatch.shapes import plate_with_disc


def put_together(mesh: TriangleMesh, *fills: tuple[FloatArray, IntArray]) -> FilledMesh:
    """Put fills behind a mesh: new vertices (k, 3) and triangles (m, 3) of each; these count new ones from -1 down."""
    vertices, triangles = [mesh.vertices], [mesh.triangles]
    n = len(mesh.vertices)
    for points, corners in fills:
        triangles.append(np.where(corners < 0, n - 1 - corners, corners))
        vertices.append(points)
        n += len(points)
    return FilledMesh(
        TriangleMesh(np.concatenate(vertices), np.concatenate(triangles)),
        len(mesh.vertices),
        len(mesh.triangles),
        np.repeat(np.arange(len(fills)), [len(corners) for _, corners in fills]),
        np.repeat(np.arange(len(fills)), [len(points) for points, _ in fills]),
        np.zeros(len(fills)),
        np.zeros(len(fills)),
        [],
    )


def fan(rim: IntArray) -> IntArray:
    """Triangles (n, 3) from a rim, which runs against its loop, to the first new vertex."""
    return np.stack([rim, np.roll(rim, -1), np.full(len(rim), -1)], axis=1)


def tent(apex: tuple[float, float, float], n: int = 12) -> FilledMesh:
    """A flat plate with a round hole of radius 1, closed by one vertex."""
    return put_together(plate_with_disc(n, 2), (np.array([apex]), fan(np.arange(n))))


def as_holes(loops: list[IntArray]) -> LoopsToFill:
    """Loops to be filled by what is tried first: neither plane patches nor borders."""
    none = np.zeros(len(loops), bool)
    return LoopsToFill(loops, none, none)
