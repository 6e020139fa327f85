"""Practice: holes cut into undamaged surface of the very mesh that is to be repaired, where the truth is known.

They are as large as the real ones, or the largest for which the surface has room, and filled by the same code. From
them follow the energy that continues this surface best, how much of a model's displacement to believe, and how large an
error to expect.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.filling.fairing import Energy
from quadpatch.filling.fill import ClosedMesh, FilledMesh, close_holes, fair_holes
from quadpatch.mesh.boundary import boundary_edge_mask, boundary_loops, directed_edges
from quadpatch.mesh.normals import vertex_normals
from quadpatch.raycast import RayScene
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh

MAX_HOLES = 64
# Fewer holes than this decide nothing.
MIN_HOLES = 12
# Diameters that are tried, in diameters of the real holes, until enough find room.
_SIZES = (1.0, 0.7, 0.5)
_ENOUGH = 24

# Surface left between a practice hole and any other rim, in mean edge lengths: what the fairing reads.
_MARGIN_EDGES = 4.0

# Shares of the predicted displacement that are tried, and what a share must gain over none to be believed.
_SHARES = np.linspace(0.0, 1.0, 11)
_LEAST_GAIN = 0.02


@dataclass(frozen=True)
class Practice:
    """A mesh with practice holes, closed again. Real holes are open in it.

    Attributes
    ----------
    truth : RayScene
        Of the mesh without practice holes.
    closed : ClosedMesh
    diameter : float
        Of the practice holes, in mesh units.
    """

    truth: RayScene
    closed: ClosedMesh
    diameter: float


def practise(mesh: TriangleMesh, diameter: float, edge_length: float, rng: np.random.Generator) -> Practice | None:
    """Cut holes into undamaged surface and close them.

    Parameters
    ----------
    mesh : TriangleMesh
    diameter : float
        Of the real holes, in mesh units.
    edge_length : float
        Mean edge length, in mesh units.
    rng : numpy.random.Generator
        Picks the places.

    Returns
    -------
    Practice or None
        None where the undamaged surface has no room for enough holes.
    """
    best: tuple[TriangleMesh, list[IntArray], float] | None = None
    for size in _SIZES:
        punched = _punch(mesh, size * diameter / 2, _MARGIN_EDGES * edge_length, rng)
        loops = _new_loops(mesh, punched)
        if len(loops) >= MIN_HOLES and (best is None or len(loops) > len(best[1])):
            best = punched, loops, size * diameter
        if len(loops) >= _ENOUGH:
            break
    if best is None:
        return None
    punched, loops, used = best
    return Practice(RayScene(mesh), close_holes(punched, loops), used)


def choose_energy(practice: Practice, energies: Sequence[Energy]) -> Energy:
    """Choose the energy that leaves the practice holes closest to the truth."""
    errors = []
    for energy in energies:
        truth, _ = distance_to_truth(practice, fair_holes(practice.closed, energy))
        errors.append(float(np.nanmean(np.abs(truth))) if np.isfinite(truth).any() else np.inf)
    return energies[int(np.argmin(errors))]


def distance_to_truth(practice: Practice, filled: FilledMesh) -> tuple[FloatArray, FloatArray]:
    """Signed distances (k,) of all new vertices along their normals (k, 3) to the true surface; NaN out of reach."""
    first = filled.n_measured_vertices
    points = filled.mesh.vertices[first:]
    normals = vertex_normals(filled.mesh.vertices, filled.mesh.triangles)[first:]
    # Start a little behind, so that a surface at distance 0 is hit.
    behind = 1e-6 * practice.diameter
    distances = []
    for sign in (1.0, -1.0):
        triangle, distance = practice.truth.cast(
            points - sign * behind * normals, sign * normals, practice.diameter + behind
        )
        distances.append(np.where(triangle >= 0, distance - behind, np.inf))
    ahead, back = distances
    nearest = np.where(ahead <= back, ahead, -back)
    return np.where(np.abs(nearest) < practice.diameter, nearest, np.nan), normals


def believed_share(truth: FloatArray, along: FloatArray) -> float:
    """Choose the share of predicted displacements (k,) that leaves the smallest mean error; 0 where none helps."""
    usable = np.isfinite(truth)
    if not usable.any():
        return 0.0
    errors = [float(np.abs(truth[usable] - share * along[usable]).mean()) for share in _SHARES]
    best = int(np.argmin(errors))
    return float(_SHARES[best]) if errors[best] < (1 - _LEAST_GAIN) * errors[0] else 0.0


def error_per_gap(filled: FilledMesh, error: FloatArray) -> float:
    """Mean error of the practice holes in units of their gap (see `FilledMesh`); errors (k,) may hold NaN."""
    usable = np.isfinite(error)
    gap = filled.gap[filled.vertex_hole[usable]]
    total = float(gap.sum())
    return float(np.abs(error[usable]).sum()) / total if total > 0 else 0.0


def _punch(mesh: TriangleMesh, radius: float, margin: float, rng: np.random.Generator) -> TriangleMesh:
    """Remove disks of surface that keep clear of every boundary and of each other."""
    normals = vertex_normals(mesh.vertices, mesh.triangles)
    tree = cKDTree(mesh.vertices)
    clear = _far_from_boundary(mesh, tree, radius + margin)
    gone = np.zeros(len(mesh.vertices), bool)
    count = 0
    for centre in rng.permutation(np.flatnonzero(clear)).tolist():
        if not clear[centre]:
            continue
        around = np.array(tree.query_ball_point(mesh.vertices[centre], 2 * (radius + margin)))
        distance = np.linalg.norm(mesh.vertices[around] - mesh.vertices[centre], axis=1)
        gone[around[(distance < radius) & (normals[around] @ normals[centre] > 0)]] = True
        clear[around] = False
        count += 1
        if count == MAX_HOLES:
            break
    return TriangleMesh(mesh.vertices, mesh.triangles[~gone[mesh.triangles].any(axis=1)])


def _far_from_boundary(mesh: TriangleMesh, tree: "cKDTree[None]", distance: float) -> BoolArray:
    """Vertices (n,) that a triangle uses and that keep a distance from every boundary edge."""
    far = np.zeros(len(mesh.vertices), bool)
    far[mesh.triangles] = True
    rim = _boundary_vertices(mesh)
    if len(rim):
        nearest, _ = cKDTree(mesh.vertices[rim]).query(mesh.vertices, distance_upper_bound=distance)
        far &= nearest > distance
    return far


def _new_loops(mesh: TriangleMesh, punched: TriangleMesh) -> list[IntArray]:
    old = np.zeros(len(mesh.vertices), bool)
    old[_boundary_vertices(mesh)] = True
    boundary = boundary_loops(punched.triangles)
    pairs = zip(boundary.loops, boundary.is_manifold, strict=True)
    return [loop for loop, is_manifold in pairs if is_manifold and not old[loop].any()]


def _boundary_vertices(mesh: TriangleMesh) -> IntArray:
    return np.unique(directed_edges(mesh.triangles)[boundary_edge_mask(mesh.triangles)])
