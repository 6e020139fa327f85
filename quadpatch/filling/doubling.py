"""Fills that lie on the back of the surface whose border they close: the sheet would be doubled."""

import numpy as np

from quadpatch.filling.filled_mesh import FilledMesh, rim_diagonals
from quadpatch.mesh.averages import mean_by
from quadpatch.mesh.distance import nearest_triangles
from quadpatch.mesh.normals import triangle_normals
from quadpatch.types import BoolArray, IntArray

# A fill doubles the surface where it is closer to it than this share of the rim's size, and faces the other way.
CLOSE = 0.05
# So much of a fill's triangles have to.
MOST = 0.5


def doubles_surface(filled: FilledMesh, loops: IntArray) -> BoolArray:
    """Tell the fills that double measured surface.

    Parameters
    ----------
    filled : FilledMesh
    loops : (k,) int64
        Positions of the loops that are looked at.

    Returns
    -------
    (n_loops,) bool
        False for all others.
    """
    n_loops, mesh = len(filled.disagreement), filled.mesh
    hole = filled.triangle_hole[np.isin(filled.triangle_hole, loops)]
    if not len(hole):
        return np.zeros(n_loops, bool)
    measured = filled.measured
    new_all = mesh.triangles[filled.n_measured_triangles :]
    new = new_all[np.isin(filled.triangle_hole, loops)]
    distance, nearest = nearest_triangles(mesh.vertices[new].mean(axis=1), measured)
    agreement = np.einsum(
        "ij,ij->i", triangle_normals(mesh.vertices, new), triangle_normals(mesh.vertices, measured.triangles[nearest])
    )
    sizes = rim_diagonals(mesh.vertices, new_all, filled.triangle_hole, filled.n_measured_vertices, n_loops)
    is_back = (distance < CLOSE * sizes[hole]) & (agreement < -0.5)
    share = mean_by(hole, is_back.astype(np.float64), n_loops)
    return np.asarray(share > MOST)
