"""Holes closed by MeshLab: where the paper starts from, and what it is measured against.

Each hole is closed by itself, next to the triangles around it: MeshLab's refinement goes through the whole mesh that it
is given, once for every hole.
"""

import numpy as np

from quadpatch.errors import StageError
from quadpatch.filling.fill import close_flat
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.refinement import Refined
from quadpatch.filling.rim_neighbourhood import RimNeighbourhood
from quadpatch.mesh.meshlab import close_holes
from quadpatch.mesh.topology import directed_edges, face_components
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices


def close_by_meshlab(mesh: TriangleMesh, loops: list[IntArray]) -> FilledMesh:
    """Close boundary loops by MeshLab, refined to the edges around them.

    Parameters
    ----------
    mesh : TriangleMesh
    loops : list of (n_loop,) int64
        Simple loops with the surface on their left, as `boundary_loops` gives them.

    Returns
    -------
    FilledMesh
        The input's vertices and triangles are its bit-exact prefix. Its disagreement and rim variation are NaN: nothing
        is known of its error. A loop that MeshLab leaves open is closed by `close_flat`.
    """
    filled = _closed_one_by_one(mesh, loops)
    if not filled.unfilled:
        return filled
    left = np.array(filled.unfilled, np.int64)
    ours = close_flat(mesh, [loops[i] for i in filled.unfilled])
    return filled.with_fills(ours.as_part_of(left, filled), left)


def _closed_one_by_one(mesh: TriangleMesh, loops: list[IntArray]) -> FilledMesh:
    near = RimNeighbourhood.of(mesh, loops)
    vertices, triangles, hole, unfilled = [near.vertices], [np.zeros((0, 3), np.int64)], [np.zeros(0, np.int64)], []
    n_vertices = len(near.vertices)
    # Loop over holes, not vertices.
    for i, loop in enumerate(near.loops):
        closed = _close(near, loop)
        if closed is None:
            unfilled.append(i)
            continue
        new_vertices, new_triangles = closed
        vertices.append(new_vertices)
        triangles.append(np.where(new_triangles < 0, n_vertices - new_triangles - 1, new_triangles))
        hole.append(np.full(len(new_triangles), i, np.int64))
        n_vertices += len(new_vertices)
    all_vertices = np.concatenate(vertices)
    patch = Refined(
        all_vertices, np.concatenate(triangles), np.concatenate(hole), np.zeros(len(all_vertices)), len(near.vertices)
    )
    return near.filled(patch, unfilled)


def _close(near: RimNeighbourhood, loop: IntArray) -> tuple[Vertices, Triangles] | None:
    """Close one hole: new vertices (n, 3), and triangles (m, 3), new vertex k as -1 - k; None if it stays open."""
    touches = np.isin(near.adjacent_triangles, loop).any(axis=1)
    used, local = np.unique(near.adjacent_triangles[touches], return_inverse=True)
    around = TriangleMesh(near.vertices[used], local.reshape(-1, 3))
    try:
        closed = close_holes(around, len(loop), _mean_rim_edge(near.vertices[loop]))
    except StageError:  # a rim at edges of three faces
        return None
    new = closed.triangles[len(around.triangles) :]
    new = new[_spans(new, np.searchsorted(used, loop), len(used), len(closed.vertices))]
    if not len(new):
        return None
    invented = np.unique(new[new >= len(used)])
    numbers = np.concatenate([used, np.zeros(len(closed.vertices) - len(used), np.int64)])
    numbers[invented] = -1 - np.arange(len(invented))
    return closed.vertices[invented], numbers[new]


def _spans(new: Triangles, loop: IntArray, n_measured: int, n_vertices: int) -> BoolArray:
    """Say which new triangles (m,) close a loop; none where they don't close all of it."""
    if not len(new):
        return np.zeros(0, np.bool_)
    piece = face_components(new, n_vertices)
    is_foreign = ((new < n_measured) & ~np.isin(new, loop)).any(axis=1)
    mine = ~np.isin(piece, piece[is_foreign])
    edges = directed_edges(new[mine])
    wanted = np.stack([np.roll(loop, -1), loop], axis=1)
    keys, wanted_keys = edges[:, 0] * n_vertices + edges[:, 1], wanted[:, 0] * n_vertices + wanted[:, 1]
    return np.asarray(mine if np.isin(wanted_keys, keys).all() else np.zeros_like(mine))


def _mean_rim_edge(rim: FloatArray) -> float:
    return float(np.linalg.norm(rim - np.roll(rim, -1, axis=0), axis=1).mean())
