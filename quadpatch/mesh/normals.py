"""Normals of triangles and vertices."""

import numpy as np

from quadpatch.mesh.topology import compacted
from quadpatch.types import FloatArray, IntArray, Triangles, Vertices

_TINY = 1e-300


def triangle_normals(vertices: Vertices, triangles: Triangles) -> FloatArray:
    """Give unit normals (n_triangles, 3); zero where a triangle has no area."""
    return unit(area_vectors(vertices, triangles))


def vertex_normals(vertices: Vertices, triangles: Triangles) -> FloatArray:
    """Average the normals around each vertex, weighted by area: (n_vertices, 3), unit length or zero."""
    vectors = area_vectors(vertices, triangles)
    corners = triangles.ravel()
    return unit(
        np.stack([np.bincount(corners, np.repeat(vectors[:, k], 3), minlength=len(vertices)) for k in range(3)], axis=1)
    )


def normals_at(vertices: Vertices, triangles: Triangles, wanted: IntArray) -> FloatArray:
    """Average the normals around some vertices (k,), as `vertex_normals` does for all: (k, 3), unit length or zero."""
    is_wanted = np.zeros(len(vertices), bool)
    is_wanted[wanted] = True
    touched = is_wanted[triangles[:, 0]] | is_wanted[triangles[:, 1]] | is_wanted[triangles[:, 2]]
    used, local = compacted(triangles[touched], len(vertices))
    normals = vertex_normals(vertices[used], local)
    position = np.searchsorted(used, wanted).clip(max=max(len(used) - 1, 0))
    found = np.zeros((len(wanted), 3))
    is_used = used[position] == wanted if len(used) else np.zeros(len(wanted), bool)
    found[is_used] = normals[position[is_used]]
    return found


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Cross products of vectors (..., 3): `numpy.cross` without its bookkeeping, which costs more than small arrays."""
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-1)


def length(vectors: FloatArray) -> FloatArray:
    """Lengths (...) of vectors (..., 3)."""
    return np.asarray(np.sqrt(np.einsum("...k,...k->...", vectors, vectors)))


def area_vectors(vertices: Vertices, triangles: Triangles) -> FloatArray:
    """Vectors (n_triangles, 3) along the normals, twice as long as the areas."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return cross(b - a, c - a)


def vertex_areas(vertices: Vertices, triangles: Triangles) -> FloatArray:
    """Areas (n_vertices,) of a third of the triangles at every vertex, in mesh units squared."""
    thirds = length(area_vectors(vertices, triangles)) / 6
    return np.asarray(np.bincount(triangles.ravel(), np.repeat(thirds, 3), minlength=len(vertices)), np.float64)


def unit(vectors: FloatArray) -> FloatArray:
    """Divide vectors (n, 3) by their lengths; zero vectors stay zero."""
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    scaled: FloatArray = vectors / np.maximum(lengths, _TINY)
    return scaled
