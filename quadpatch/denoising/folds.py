"""Folds that a move of the vertices brings into a mesh, and taking them out again.

Tested in `tests/quadpatch/denoising/test_folds.py`.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.edge_groups import group_edges
from quadpatch.mesh.normals import triangle_normals
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Vertices

# Two triangles whose normals differ by more fold over each other, as in `quadpatch.filling.faults`.
FOLD_ANGLE_DEG = 150.0
# Every time the moves around a fold are halved; the last time they are taken back.
_HALVINGS = 6


@dataclass(frozen=True)
class Unfolded:
    """Moves without the folds that they brought in.

    Attributes
    ----------
    moves : (n, 3) float64
        In mesh units.
    n_undone : int
        Folds that the moves brought in and that are gone again.
    left : (k, 2) int64
        Pairs of triangles that still fold and did not before.
    n_before : int
        Folds of the mesh as it came.
    """

    moves: FloatArray
    n_undone: int
    left: IntArray
    n_before: int


def without_new_folds(mesh: TriangleMesh, moves: FloatArray) -> Unfolded:
    """Shorten the moves (n, 3) of vertices at edges that fold after them and did not before.

    Parameters
    ----------
    mesh : TriangleMesh
    moves : (n, 3) float64
        In mesh units.

    Returns
    -------
    Unfolded
        Where a fold goes away only together with a move next to it, a few may be left.
    """
    pairs = group_edges(mesh.triangles, len(mesh.vertices)).pairs // 3
    before = _folds(mesh.vertices, mesh, pairs)
    new = np.flatnonzero(_folds(mesh.vertices + moves, mesh, pairs) & ~before)
    n_new, moves = len(new), moves.copy()
    # A vertex that is held back may fold the triangles around it.
    for attempt in range(2 * _HALVINGS):
        if not len(new):
            break
        around = np.unique(mesh.triangles[pairs[new]])
        moves[around] *= 0.5 if attempt < _HALVINGS else 0.0
        new = np.flatnonzero(_folds(mesh.vertices + moves, mesh, pairs) & ~before)
    return Unfolded(moves, n_new - len(new), pairs[new], int(before.sum()))


def n_turned(mesh: TriangleMesh, vertices: Vertices) -> int:
    """Count the triangles whose normal turns by more than a right angle where the vertices (n, 3) move."""
    before = triangle_normals(mesh.vertices, mesh.triangles)
    after = triangle_normals(vertices, mesh.triangles)
    return int((np.einsum("ij,ij->i", before, after) < 0).sum())


def _folds(vertices: Vertices, mesh: TriangleMesh, pairs: IntArray) -> BoolArray:
    """Tell the pairs (p, 2) of neighbouring triangles that fold; one without an area folds with none."""
    normals = triangle_normals(vertices, mesh.triangles)
    cosine = np.einsum("ij,ij->i", normals[pairs[:, 0]], normals[pairs[:, 1]])
    return np.asarray(cosine < np.cos(np.radians(FOLD_ANGLE_DEG)))
