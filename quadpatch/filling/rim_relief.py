"""Relief of rims whose measured triangles have no height.

The normal of a triangle without height is rounding noise. Where it points against the fill beside it, programs that
look at normals see a fold. The new triangle is split close to the common edge, and the strip along that edge is tilted
until the two normals differ by less than a fold does. The strip is narrow, so the surface hardly changes.
"""

from dataclasses import replace

import numpy as np

from quadpatch.filling.faults import find_folds
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.normals import area_vectors, cross, length, unit
from quadpatch.types import FloatArray, IntArray, TriangleMesh

# Width of the strip, in lengths of the rim edge, and at most so much of the height of its triangle.
_STRIP = 0.05
_MOST_OF_HEIGHT = 0.2
# Angle that is left between the normals.
_ANGLE_DEG = 140.0
# A triangle with several such edges is split once a round.
_MAX_ROUNDS = 3


def relieve_rims(filled: FilledMesh) -> FilledMesh:
    """Tilt narrow strips of a fill where it folds against measured triangles without height.

    Returns
    -------
    FilledMesh
        With one vertex and two triangles more for every edge that was relieved, or for two that lie on a line.
    """
    everywhere = np.ones(len(filled.disagreement), bool)
    for _ in range(_MAX_ROUNDS):
        folds = find_folds(filled, everywhere)
        wanted = np.flatnonzero(folds.is_flat_rim & ~folds.is_sliver)
        # New triangles come after measured ones.
        new, first = np.unique(folds.pairs[wanted].max(axis=1), return_index=True)
        if not len(new):
            break
        at = wanted[first]
        filled = _split(filled, new, folds.pairs[at].min(axis=1), folds.edges[at])
    return filled


def _split(filled: FilledMesh, new: IntArray, measured: IntArray, edges: IntArray) -> FilledMesh:
    """Split new triangles (k,) by a vertex close to the edges (k, 2) that they share with measured ones (k,).

    Two edges of one measured triangle lie on a line. Their triangles share the new vertex, on the edge between them: no
    other piece touches the line in the vertex where the two meet, since rounding would decide whether it crosses there.
    """
    vertices, triangles = filled.mesh.vertices, filled.mesh.triangles
    hole = filled.triangle_hole[new - filled.n_measured_triangles]
    # Turn the triangles so that the shared edge runs from the first corner to the second.
    apex = ~(triangles[new][:, :, None] == edges[:, None, :]).any(axis=2)
    a, b, c = (triangles[new, (apex.argmax(axis=1) + k) % 3] for k in (1, 2, 0))
    leaving = {key: i for i, key in enumerate(zip(measured.tolist(), c.tolist(), a.tolist(), strict=True))}
    arriving = [leaving.get(key, -1) for key in zip(measured.tolist(), c.tolist(), b.tolist(), strict=True)]
    one = np.flatnonzero(np.array(arriving) >= 0)
    other = np.array(arriving)[one]
    starts, ends = (np.isin(np.arange(len(new)), rows) for rows in (one, other))
    x = len(vertices) + np.cumsum(~ends) - 1
    x[other] = x[one]
    middle = (vertices[a] + vertices[b]) / 2
    middle[one] = vertices[b[one]]
    against = unit(area_vectors(vertices, triangles[measured]))
    middle += _across(vertices[a], vertices[b], vertices[c], against)
    changed = triangles.copy()
    changed[new] = np.stack([a, b, x], axis=1)
    added = np.concatenate([np.stack([b, c, x], axis=1)[~starts], np.stack([c, a, x], axis=1)[~ends]])
    return replace(
        filled,
        mesh=TriangleMesh(np.concatenate([vertices, middle[~ends]]), np.concatenate([changed, added])),
        triangle_hole=np.concatenate([filled.triangle_hole, hole[~starts], hole[~ends]]),
        vertex_hole=np.concatenate([filled.vertex_hole, hole[~ends]]),
    )


def _across(a: FloatArray, b: FloatArray, c: FloatArray, against: FloatArray) -> FloatArray:
    """Give the vectors (k, 3) across strips at the edges from a to b, such that they turn away from some normals."""
    along = unit(b - a)
    normal = unit(cross(b - a, c - a))
    inwards = cross(normal, along)
    # Angle of the normal that is turned away from, about the edge: `inwards` is that of a quarter turn.
    angle = np.arctan2(np.einsum("ij,ij->i", against, inwards), np.einsum("ij,ij->i", against, normal))
    tilt = np.sign(angle) * np.maximum(np.abs(angle) - np.radians(_ANGLE_DEG), 0.0)
    edge = length(b - a)
    height = np.einsum("ij,ij->i", c - a, inwards)
    width = np.minimum(_STRIP * edge, _MOST_OF_HEIGHT * height)
    direction = np.cos(tilt)[:, None] * inwards - np.sin(tilt)[:, None] * normal
    return np.asarray(width[:, None] * direction)
