"""The part of a scan that a repair works on: the surroundings of its holes, and places to calibrate at.

Calibration and learning look at as much surface as they need, wherever it lies: a scan ten times as large has no more
of it. Where these places take up most of a scan, the whole of it is looked at.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.calibration.calibration_set import MARGIN_EDGES, MAX_HOLES
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.region import Region, region_around
from quadpatch.mesh.measures import EdgeStatistics
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# A fill that bulges stays within so many diameters of its rim; whether it did is looked at.
_BULGE = 0.5
# What fills and their checks read of the surface around a hole, in mean edge lengths.
_RINGS = 8.0
# Room for one calibration hole, in radii of what the hole and its margin take: there is more than one place for it.
_ROOM = 1.5
# Patches of a hole reach one patch length beyond it, and what smooths the surface below them about as far again.
_PATCHES = 2.0
# Places that are tried for each one that is looked for.
_TRIES = 30


@dataclass(frozen=True)
class RepairRegion:
    """What a repair works on.

    Attributes
    ----------
    region : Region
    centres : (n_loops, 3) float64
    radii : (n_loops,) float64
        Every triangle of the scan that comes so near to the centre of a loop is in the region; in mesh units.
    """

    region: Region
    centres: Vertices
    radii: FloatArray

    @classmethod
    def all_of(cls, mesh: TriangleMesh, n_loops: int) -> "RepairRegion":
        """Work on a whole mesh."""
        return cls(Region.all_of(mesh), np.zeros((n_loops, 3)), np.full(n_loops, np.inf))

    def holds(self, filled: FilledMesh) -> bool:
        """Whether all that fills could run into is in the region: they lie where it has all triangles of the scan."""
        new = filled.mesh.vertices[filled.n_measured_vertices :]
        distance = np.linalg.norm(new - self.centres[filled.vertex_hole], axis=1)
        return bool((distance <= self.radii[filled.vertex_hole]).all())


@dataclass(frozen=True)
class Reach:
    """Lengths that a repair looks around by, in mesh units.

    Attributes
    ----------
    diameter : float
        Of calibration holes.
    patch_length : float
        Side of the patches of a learned model; 0 without one.
    edges : EdgeStatistics
        Of the scan.
    """

    diameter: float
    patch_length: float
    edges: EdgeStatistics


def repair_region(
    mesh: TriangleMesh,
    loops: list[IntArray],
    reach: Reach,
    obstacles: Triangles | None,
    rng: np.random.Generator,
) -> RepairRegion:
    """Choose the part of a scan that a repair works on.

    Parameters
    ----------
    mesh : TriangleMesh
    loops : list of (n_loop,) int64
        Rims of the holes.
    reach : Reach
    obstacles : (k, 3) int64, optional
        Triangles of the file that the mesh leaves out.
    rng : numpy.random.Generator
        Picks the places to calibrate at.
    """
    if not loops:
        return RepairRegion.all_of(mesh, 0)
    low = np.array([mesh.vertices[loop].min(axis=0) for loop in loops])
    high = np.array([mesh.vertices[loop].max(axis=0) for loop in loops])
    sizes = np.linalg.norm(high - low, axis=1)
    around = _RINGS * reach.edges.mean + _PATCHES * reach.patch_length
    room = _ROOM * (reach.diameter / 2 + MARGIN_EDGES * reach.edges.mean) + around
    sites = _sites(mesh, np.concatenate(loops), room, MAX_HOLES, rng)
    if len(sites) < MAX_HOLES:
        return RepairRegion.all_of(mesh, len(loops))
    centres, radii = (low + high) / 2, (0.5 + _BULGE) * sizes + around
    region = region_around(
        mesh,
        reach.edges,
        np.concatenate([centres, sites]),
        np.concatenate([radii, np.full(len(sites), room)]),
        obstacles,
    )
    if region.mesh is mesh:
        return RepairRegion.all_of(mesh, len(loops))
    return RepairRegion(region, centres, radii)


def _sites(mesh: TriangleMesh, rim: IntArray, room: float, most: int, rng: np.random.Generator) -> Vertices:
    """Pick places (k, 3) on the surface that keep clear of rims and of each other."""
    corners = mesh.triangles[rng.integers(len(mesh.triangles), size=_TRIES * most), 0]
    candidates = mesh.vertices[corners]
    candidates = candidates[cKDTree(mesh.vertices[rim]).query(candidates)[0] > room]
    taken = np.zeros((0, 3))
    for place in candidates:
        if (np.linalg.norm(taken - place, axis=1) > 2 * room).all():
            taken = np.concatenate([taken, place[np.newaxis]])
        if len(taken) == most:
            break
    return taken
