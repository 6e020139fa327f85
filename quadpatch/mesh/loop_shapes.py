"""Measures of boundary loops as arrays, all loops at once.

Tested in `tests/quadpatch/mesh/test_hole_measures.py`.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.loop_diameter import loop_diameter
from quadpatch.mesh.loops import by_length
from quadpatch.mesh.normals import cross, normals_at
from quadpatch.mesh.rims import Rims
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Vertices

# Loops of up to so many vertices are measured together, so many at a time.
_SMALL_LOOP = 16
_AT_ONCE = 4096


@dataclass(frozen=True)
class LoopShapes:
    """Measures of all loops, by their position.

    Attributes
    ----------
    centres : (n, 3) float64
        Mean of the vertices.
    plane_normals : (n, 3) float64
        Unit normal of the best plane, of either sign.
    planarity, diameters, perimeters : (n,) float64
    vector_areas : (n, 3) float64
    rim_normals : (n, 3) float64
        Mean of the unit normals at the vertices, shorter where these disagree.
    """

    centres: FloatArray
    plane_normals: FloatArray
    planarity: FloatArray
    diameters: FloatArray
    perimeters: FloatArray
    vector_areas: FloatArray
    rim_normals: FloatArray

    @property
    def roundness(self) -> FloatArray:
        """Isoperimetric quotient (n,): area by that of a circle of the same perimeter."""
        areas = np.linalg.norm(self.vector_areas, axis=1)
        return np.asarray(4 * np.pi * areas / np.maximum(self.perimeters, 1e-150) ** 2)


def perimeters(points: Vertices, starts: IntArray) -> FloatArray:
    """Measure closed loops, (n_loops,), by their points (n, 3), end to end, and where each starts (n_loops + 1,).

    A loop's perimeter does not depend on the others.
    """

    def of_equal(points: FloatArray) -> FloatArray:
        return np.asarray(np.linalg.norm(np.roll(points, -1, axis=1) - points, axis=2).sum(axis=1))

    return _measured(points, starts, of_equal)


def diameters(points: Vertices, starts: IntArray) -> FloatArray:
    """Measure the largest distance between two points of each loop, (n_loops,), given as for `perimeters`."""

    def of_equal(points: FloatArray) -> FloatArray:
        if points.shape[1] > _SMALL_LOOP:
            return np.array([loop_diameter(of_loop) for of_loop in points])
        return np.asarray(np.linalg.norm(points[:, :, None] - points[:, None], axis=3).max(axis=(1, 2)))

    return _measured(points, starts, of_equal)


def _measured(points: Vertices, starts: IntArray, of_equal: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """Measure loops that are equally long (k, n, 3) together: scans have a hundred thousand holes of three edges."""
    result = np.zeros(len(starts) - 1)
    for members, places in by_length(starts):
        for at in range(0, len(members), _AT_ONCE):
            result[members[at : at + _AT_ONCE]] = of_equal(points[places[at : at + _AT_ONCE]])
    return result


def measure_loops(mesh: TriangleMesh, rims: Rims, loops: list[IntArray], lengths: FloatArray) -> LoopShapes:
    """Measure all loops at once.

    Parameters
    ----------
    mesh : TriangleMesh
    rims : Rims
        Of the loops.
    loops : list of (n_loop,) int64
    lengths : (n_loops,) float64
        Their perimeters.
    """
    counts = np.diff(rims.starts)[:, None]
    centres = rims.sums(rims.points) / counts
    centred = rims.points - centres[rims.loop]
    # Half the sum of cross products along a loop is the same for every surface that the loop spans; its length is the
    # largest area that the loop projects to.
    vector_areas = rims.sums(cross(centred, rims.edges)) / 2
    plane_normals = _plane_normals(rims, centred)
    distances = np.einsum("ij,ij->i", centred, plane_normals[rims.loop])
    away = np.sqrt(rims.sums(distances**2) / counts[:, 0])
    reach = 2 * np.maximum.reduceat(np.linalg.norm(centred, axis=1), rims.starts[:-1])
    planarity = np.where(reach > 0, away / np.maximum(reach, 1e-300), 0.0)
    normals = normals_at(mesh.vertices, mesh.triangles, np.concatenate(loops))
    rim_normals = rims.sums(normals) / counts
    widths = diameters(rims.points, rims.starts)
    return LoopShapes(centres, plane_normals, planarity, widths, lengths, vector_areas, rim_normals)


def _plane_normals(rims: Rims, centred: FloatArray) -> FloatArray:
    """Find the normals (n_loops, 3) of the best planes: there the points of a loop scatter least."""
    # Scaled first: squares of a mesh that is very small or large would leave float64.
    size = np.maximum.reduceat(np.abs(centred).max(axis=1), rims.starts[:-1])
    scaled = centred / np.maximum(size, 1e-300)[rims.loop][:, None]
    scatter = rims.sums(scaled[:, :, None] * scaled[:, None, :])
    return np.linalg.eigh(scatter)[1][:, :, 0]
