"""From predicted height maps to positions, as in section 3 of the paper: vertices are placed anew by their patches.

Connectivity says where in which patches a vertex lies. Each of these patches puts it at its place in their plane,
lifted by the predicted height; the vertex comes to lie at the plain mean of these points.
"""

import numpy as np

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.averages import mean_by
from quadpatch.mesh.harmonic import extend_harmonically
from quadpatch.mesh.normals import vertex_normals
from quadpatch.mesh.topology import directed_edges
from quadpatch.patches.connectivity import Connectivity, bilinear, vertices_in_balls
from quadpatch.reconstruction.displacement import Displacement, averaged
from quadpatch.types import FloatArray, IntArray, Patches, Vertices


def place(filled: FilledMesh, vertices: IntArray, patches: Patches, predicted: FloatArray) -> Displacement:
    """Place some vertices of a filled mesh at the mean of what overlapping patches predict.

    Parameters
    ----------
    filled : FilledMesh
    vertices : (n,) int64
        Vertices of the filled mesh.
    patches : Patches
        As sampled from the filled mesh.
    predicted : (n_patches, N, N) float64
        Heights, in mesh units.

    Returns
    -------
    Displacement
        From where the vertices are to where they belong; zero where no patch sees one.
    """
    positions = filled.mesh.vertices[vertices]
    normals = vertex_normals(filled.mesh.vertices, filled.mesh.triangles)[vertices]
    return mean_moves(positions, vertices_in_balls(positions, normals, patches), patches, predicted)


def mean_moves(positions: Vertices, seen: Connectivity, patches: Patches, predicted: FloatArray) -> Displacement:
    """Average what overlapping patches predict for vertices whose bins are known.

    Parameters
    ----------
    positions : (n, 3) float64
        Where the vertices are now.
    seen : Connectivity
        Of these vertices in the patches.
    patches : Patches
    predicted : (n_patches, N, N) float64
        Heights, in mesh units.

    Returns
    -------
    Displacement
        From where the vertices are to where they belong; zero where no patch sees one.
    """
    z = patches.frames[seen.patch, 2]
    # Its place in the plane is where it is already: only its height over the plane is new.
    height = np.einsum("ij,ij->i", positions[seen.vertex] - patches.origins[seen.patch], z)
    moves = (bilinear(predicted, seen) - height)[:, None] * z
    return averaged(moves, np.ones(len(moves)), seen, len(positions))


def with_ring_means(filled: FilledMesh, placed: Displacement) -> FloatArray:
    """Put new vertices that no patch sees at the mean of the vertices around them, in holes of which patches see some.

    Parameters
    ----------
    filled : FilledMesh
    placed : Displacement
        Of all its new vertices.

    Returns
    -------
    (n_invented_vertices, 3) float64
        Displacements, in mesh units; zero in holes that no patch sees.
    """
    n_measured, hole = filled.n_measured_vertices, filled.vertex_hole
    seen = placed.overlap > 0
    is_seen_hole = mean_by(hole, seen.astype(np.float64), len(filled.disagreement)) > 0
    wanted = ~seen & is_seen_hole[hole]
    if not wanted.any():
        return placed.mean
    used, local = np.unique(directed_edges(filled.mesh.triangles[filled.n_measured_triangles :]), return_inverse=True)
    new = np.flatnonzero(used >= n_measured)
    positions = filled.mesh.vertices[used]
    positions[new] += placed.mean[used[new] - n_measured]
    known = np.ones(len(used), np.bool_)
    known[new] = ~wanted[used[new] - n_measured]
    means = extend_harmonically(local.reshape(-1, 2), known, positions)
    moves = placed.mean.copy()
    moves[used[new] - n_measured] = means[new] - filled.mesh.vertices[used[new]]
    return moves
