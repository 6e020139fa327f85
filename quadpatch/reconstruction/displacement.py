"""From predicted height maps to displacements of the fill.

The geometric fill carries the new vertices. A patch says, at every vertex it sees, how far along its z the surface
should lie from where it is; the weighted mean over all patches that see the vertex is its displacement. At the rim
the surface is measured and must stay, so the displacement found there (the misfit of the model) is continued
harmonically into the hole and taken off: the displaced fill meets the rim exactly.

References
----------
K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019, section 3.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.harmonic import extend_harmonically
from quadpatch.mesh.normals import vertex_normals
from quadpatch.mesh.topology import directed_edges
from quadpatch.patches.connectivity import Connectivity, bilinear, vertices_in_patches
from quadpatch.types import FloatArray, IntArray, Patches


@dataclass(frozen=True)
class Displacement:
    """What the patches say about some vertices.

    Attributes
    ----------
    mean : (n, 3) float64
        Weighted mean displacement, in mesh units; zero where no patch sees the vertex.
    deviation : (n,) float64
        Weighted standard deviation between patches, in mesh units.
    overlap : (n,) int64
        Count of patches that see the vertex.
    """

    mean: FloatArray
    deviation: FloatArray
    overlap: IntArray


def displace(filled: FilledMesh, vertices: IntArray, patches: Patches, predicted: FloatArray) -> Displacement:
    """Average what overlapping patches predict at some vertices of a filled mesh.

    Parameters
    ----------
    filled : FilledMesh
    vertices : (n,) int64
        Vertices of the filled mesh.
    patches : Patches
        As sampled from the filled mesh.
    predicted : (n_patches, N, N) float64
        Heights, in mesh units.
    """
    normals = vertex_normals(filled.mesh.vertices, filled.mesh.triangles)[vertices]
    seen = vertices_in_patches(filled.mesh.vertices[vertices], normals, patches)
    return mean_displacement(normals, seen, patches, bilinear(predicted - patches.heights, seen))


def mean_displacement(normals: FloatArray, seen: Connectivity, patches: Patches, along_z: FloatArray) -> Displacement:
    """Average over patches how far they would move the vertices that they see.

    Parameters
    ----------
    normals : (n, 3) float64
        Of the vertices.
    seen : Connectivity
        Of these vertices in the patches.
    patches : Patches
    along_z : (c,) float64
        How far each pair's vertex lies off along the z of its patch, in mesh units.

    Returns
    -------
    Displacement
    """
    n = len(normals)
    # A patch that sees the surface at a slant moves it far for a small error in height.
    facing = np.einsum("ij,ij->i", normals[seen.vertex], patches.frames[seen.patch, 2])
    weight = _window(patches, seen.row, seen.column) * np.maximum(facing, 0.0) ** 2
    return averaged(along_z[:, None] * patches.frames[seen.patch, 2], weight, seen, n)


def averaged(vectors: FloatArray, weight: FloatArray, seen: Connectivity, n: int) -> Displacement:
    """Average vectors (c, 3) of pairs of a vertex and a patch over the patches of n vertices, by weights (c,)."""
    safe = np.maximum(np.bincount(seen.vertex, weight, minlength=n), 1e-300)
    mean = np.stack([np.bincount(seen.vertex, weight * vectors[:, k], minlength=n) / safe for k in range(3)], axis=1)
    squared_deviation = ((vectors - mean[seen.vertex]) ** 2).sum(axis=1)
    deviation = np.sqrt(np.bincount(seen.vertex, weight * squared_deviation, minlength=n) / safe)
    return Displacement(mean, deviation, np.bincount(seen.vertex, minlength=n))


def _window(patches: Patches, row: FloatArray, column: FloatArray) -> FloatArray:
    """Weight of a place in a patch: 1 at its centre, falling to a tenth at its border."""
    half = patches.resolution / 2
    from_centre = np.maximum(np.abs(row + 0.5 - half), np.abs(column + 0.5 - half)) / half
    return 0.1 + 0.9 * np.cos(np.clip(from_centre, 0, 1) * np.pi / 2) ** 2


def join_at_rim(filled: FilledMesh, invented: FloatArray, rim: IntArray, at_rim: FloatArray) -> FloatArray:
    """Take the misfit at the rim, continued harmonically into the holes, off the displacements.

    Parameters
    ----------
    filled : FilledMesh
    invented : (n_invented_vertices, 3) float64
        Displacements of all new vertices.
    rim : (r,) int64
        Measured vertices on the rims.
    at_rim : (r, 3) float64
        What the patches predict there, where the truth is zero.

    Returns
    -------
    (n_invented_vertices, 3) float64
    """
    if not len(invented):
        return invented
    first = filled.n_measured_vertices
    edges = np.unique(np.sort(directed_edges(filled.mesh.triangles[filled.n_measured_triangles :]), axis=1), axis=0)
    # New vertices keep their order, rim vertices come behind them.
    local = np.full(len(filled.mesh.vertices), -1)
    local[first:] = np.arange(len(invented))
    local[rim] = len(invented) + np.arange(len(rim))
    known = np.arange(len(invented) + len(rim)) >= len(invented)
    misfit = extend_harmonically(local[edges], known, np.concatenate([np.zeros_like(invented), at_rim]))
    return np.asarray(invented - misfit[: len(invented)])


def rim_vertices(filled: FilledMesh) -> tuple[IntArray, IntArray]:
    """Measured vertices of invented triangles (r,), and the position of the hole of each (r,)."""
    new = filled.mesh.triangles[filled.n_measured_triangles :]
    corner_hole = np.repeat(filled.triangle_hole, 3)
    corners = new.ravel()
    on_rim = corners < filled.n_measured_vertices
    rim, first = np.unique(corners[on_rim], return_index=True)
    return rim, corner_hole[on_rim][first]
