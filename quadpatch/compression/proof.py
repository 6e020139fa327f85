"""Distances between a mesh and what its file gives back, both ways.

Measured at every vertex and at points spread over every triangle. The distance to a surface changes no faster than the
place, so between two points it is larger than at both by at most half their spacing.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.distance import project
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Vertices

# A triangle is sampled by at most the square of this many points.
_MOST_ALONG_EDGE = 12


@dataclass(frozen=True)
class Samples:
    """Points of a mesh.

    Attributes
    ----------
    points : (n, 3) float64
        Vertices that a triangle uses, then points inside of triangles.
    triangle : (n,) int64
        A triangle that the point lies on.
    n_vertices : int
    spacing : float
        No place of the mesh is farther from its nearest sample than this, in mesh units.
    """

    points: Vertices
    triangle: IntArray
    n_vertices: int
    spacing: float


def sample(mesh: TriangleMesh, spacing: float) -> Samples:
    """Spread points over a mesh: its vertices, and the centroids of triangles cut until no edge is above `spacing`."""
    used, first = np.unique(mesh.triangles, return_index=True)
    corners = mesh.vertices[mesh.triangles]
    edge = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).max(axis=1)
    parts = np.clip(np.ceil(edge / spacing), 1, _MOST_ALONG_EDGE).astype(np.int64)
    points, triangle = [mesh.vertices[used]], [first // 3]
    # One turn for each count of parts, of which there are at most twelve.
    for n in np.unique(parts).tolist():
        members = np.flatnonzero(parts == n)
        weights = _centroids(n)
        points.append(np.einsum("sk,tkj->tsj", weights, corners[members]).reshape(-1, 3))
        triangle.append(np.repeat(members, len(weights)))
    # A triangle lies within its longest edge divided by sqrt(3) of a corner; each part has a sample or corner there.
    reach = float((edge / parts).max()) / np.sqrt(3.0) if len(edge) else 0.0
    return Samples(np.concatenate(points), np.concatenate(triangle), len(used), reach)


def _centroids(n: int) -> FloatArray:
    """Barycentric weights (n * n, 3) of the centroids of n * n equal parts of a triangle."""
    rows = [(i, j, third) for i in range(n) for j in range(n - i) for third in (1, 2) if third == 1 or i + j < n - 1]
    weights = np.array([(i + third / 3, j + third / 3) for i, j, third in rows]) / n
    return np.concatenate([weights, 1.0 - weights.sum(axis=1, keepdims=True)], axis=1)


@dataclass(frozen=True)
class Deviation:
    """Distances of samples of one mesh from another: (n,) each, in mesh units and as the nearest triangle's number."""

    samples: Samples
    distance: FloatArray
    nearest: IntArray

    @property
    def largest(self) -> float:
        """Largest distance."""
        return float(self.distance.max()) if len(self.distance) else 0.0

    @property
    def rms(self) -> float:
        """Root mean square distance of the samples."""
        return float(np.sqrt((self.distance**2).mean())) if len(self.distance) else 0.0


def deviation(samples: Samples, mesh: TriangleMesh) -> Deviation:
    """Measure how far samples lie from a mesh."""
    if not len(mesh.triangles):
        n = len(samples.points)
        return Deviation(samples, np.full(n, np.inf), np.full(n, -1))
    distance, nearest, _ = project(samples.points, mesh)
    return Deviation(samples, distance, nearest)


def psnr(diagonal: float, rms: float) -> float:
    """Peak signal to noise in decibels: 20 log10(diagonal / rms)."""
    return float(20.0 * np.log10(diagonal / rms)) if rms > 0 else float("inf")
