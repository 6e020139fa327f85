"""Practice: how well does a model do on this very mesh?

Holes like the real ones are cut into undamaged surface, filled by the same code and completed by the same model;
there the truth is known. From it follow how much of the model's displacement to believe, none if it
does not help, and how large the error of the fill is for a hole of a given difficulty.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.filling.fill import FilledMesh, fill_holes
from quadpatch.mesh.boundary import boundary_edge_mask, boundary_loops, directed_edges
from quadpatch.mesh.normals import vertex_normals
from quadpatch.raycast import RayScene
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh

MAX_HOLES = 64

# Surface left between a practice hole and any real one, in mean edge lengths: what the fairing reads.
_MARGIN_EDGES = 4

# Shares of the predicted displacement that are tried, and what a share must gain over none to be believed.
_SHARES = np.linspace(0.0, 1.0, 11)
_LEAST_GAIN = 0.02


@dataclass(frozen=True)
class Practice:
    """A copy of the mesh with practice holes, closed again.

    Attributes
    ----------
    filled : FilledMesh
        Real holes are open in it.
    truth : (n_invented_vertices,) float64
        How far along its normal each new vertex is from the true surface; NaN where the normal misses it.
    normals : (n_invented_vertices, 3) float64
    """

    filled: FilledMesh
    truth: FloatArray
    normals: FloatArray


def practise(mesh: TriangleMesh, diameter: float, edge_length: float, rng: np.random.Generator) -> Practice | None:
    """Cut holes into undamaged surface and fill them.

    Parameters
    ----------
    mesh : TriangleMesh
    diameter : float
        Of the practice holes, in mesh units.
    edge_length : float
        Mean edge length, in mesh units.
    rng : numpy.random.Generator
        Picks the places.

    Returns
    -------
    Practice or None
        None where the undamaged surface has no room for a hole of that size.
    """
    punched = _punch(mesh, diameter / 2, _MARGIN_EDGES * edge_length, rng)
    if punched is None:
        return None
    old = np.zeros(len(mesh.vertices), bool)
    old[directed_edges(mesh.triangles)[boundary_edge_mask(mesh.triangles)].ravel()] = True
    boundary = boundary_loops(punched.triangles)
    loops = [loop for loop, ok in zip(boundary.loops, boundary.is_manifold, strict=True) if ok and not old[loop].any()]
    if not loops:
        return None
    filled = fill_holes(punched, loops)
    normals = vertex_normals(filled.mesh.vertices, filled.mesh.triangles)[filled.n_measured_vertices :]
    return Practice(
        filled, _distance_to(mesh, filled.mesh.vertices[filled.n_measured_vertices :], normals, diameter), normals
    )


def _punch(mesh: TriangleMesh, radius: float, margin: float, rng: np.random.Generator) -> TriangleMesh | None:
    """Remove disks of surface that keep clear of every boundary and of each other."""
    normals = vertex_normals(mesh.vertices, mesh.triangles)
    used = np.unique(mesh.triangles)
    tree = cKDTree(mesh.vertices)
    rim = np.unique(directed_edges(mesh.triangles)[boundary_edge_mask(mesh.triangles)])
    clear = np.ones(len(mesh.vertices), bool)
    if len(rim):
        clear = (
            cKDTree(mesh.vertices[rim]).query(mesh.vertices, distance_upper_bound=radius + margin)[0] > radius + margin
        )
    gone = np.zeros(len(mesh.vertices), bool)
    count = 0
    for centre in rng.permutation(used[clear[used]]).tolist():
        if not clear[centre]:
            continue
        around = np.array(tree.query_ball_point(mesh.vertices[centre], 2 * (radius + margin)))
        distance = np.linalg.norm(mesh.vertices[around] - mesh.vertices[centre], axis=1)
        gone[around[(distance < radius) & (normals[around] @ normals[centre] > 0)]] = True
        clear[around] = False
        count += 1
        if count == MAX_HOLES:
            break
    if not gone.any():
        return None
    return TriangleMesh(mesh.vertices, mesh.triangles[~gone[mesh.triangles].any(axis=1)])


def _distance_to(mesh: TriangleMesh, points: FloatArray, normals: FloatArray, reach: float) -> FloatArray:
    """Signed distance along the normals to the nearer of the two hits, NaN beyond the reach."""
    scene = RayScene(mesh)
    distances = []
    for sign in (1.0, -1.0):
        # Start a little behind, so that a surface at distance 0 is hit.
        behind = 1e-6 * reach
        triangle, distance = scene.cast(points - sign * behind * normals, sign * normals)
        distances.append(np.where(triangle >= 0, distance - behind, np.inf))
    ahead, back = distances
    nearest = np.where(ahead <= back, ahead, -back)
    return np.where(np.abs(nearest) < reach, nearest, np.nan)


def believed_share(practice: Practice, displacement: FloatArray) -> float:
    """Choose the share of the displacements (n_invented, 3) that leaves the smallest mean error; 0 where none helps."""
    along = np.einsum("ij,ij->i", displacement, practice.normals)
    usable: BoolArray = np.isfinite(practice.truth)
    if not usable.any():
        return 0.0
    errors = [float(np.abs(practice.truth[usable] - share * along[usable]).mean()) for share in _SHARES]
    best = int(np.argmin(errors))
    return float(_SHARES[best]) if errors[best] < (1 - _LEAST_GAIN) * errors[0] else 0.0


def error_per_hole(practice: Practice, displacement: FloatArray, share: float) -> tuple[IntArray, FloatArray]:
    """Mean absolute error of the completed fill: hole positions (h,) and errors (h,) in mesh units."""
    along = share * np.einsum("ij,ij->i", displacement, practice.normals)
    usable = np.isfinite(practice.truth)
    hole = practice.filled.vertex_hole[usable]
    count = np.bincount(hole)
    total = np.bincount(hole, np.abs(practice.truth - along)[usable])
    present = np.flatnonzero(count)
    return present, total[present] / count[present]
