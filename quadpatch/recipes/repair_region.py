"""The part of a scan that a repair works on: the surroundings of its holes, and places to calibrate at.

Calibration and learning look at as much surface as they need, wherever it lies: a scan ten times as large has no more
of it. Where these places take up most of a scan, the whole of it is looked at.
"""

from dataclasses import dataclass, replace

import numpy as np

from quadpatch.calibration.calibration_set import MARGIN_EDGES, MAX_HOLES
from quadpatch.calibration.kept import array_digest
from quadpatch.calibration.sites import pick_sites
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.region import Region, region_around
from quadpatch.mesh.loops import laid_out
from quadpatch.mesh.measures import EdgeStatistics
from quadpatch.recipes.patch_surfaces import CoarseCopy
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# A fill that bulges stays within so many diameters of its rim; whether it did is looked at.
_BULGE = 0.5
# What fills and their checks read of the surface around a hole, in mean edge lengths.
_RINGS = 8.0
# Room for one calibration hole, in radii of what the hole and its margin take: there is more than one place for it.
_ROOM = 1.5
# Patches of a hole reach one patch length beyond it, and what smooths the surface below them about as far again.
_PATCHES = 2.0


@dataclass(frozen=True)
class RepairRegion:
    """What a repair works on.

    Attributes
    ----------
    region : Region
    centres : (n_loops, 3) float64
    radii : (n_loops,) float64
        Every triangle of the scan that comes so near to the centre of a loop is in the region; in mesh units.
    sites : (k, 3) float64
        Places to calibrate at.
    room : float
        The same for the places to calibrate at.
    """

    region: Region
    centres: Vertices
    radii: FloatArray
    sites: Vertices
    room: float

    @classmethod
    def all_of(cls, mesh: TriangleMesh, n_loops: int) -> "RepairRegion":
        """Work on a whole mesh."""
        return cls(Region.all_of(mesh), np.zeros((n_loops, 3)), np.full(n_loops, np.inf), np.zeros((0, 3)), np.inf)

    def digest(self) -> str:
        """Hash what says, besides the scan, what belongs to the region."""
        places = (self.centres, self.radii, self.sites, np.array([self.room]))
        return array_digest(*places) if len(self.sites) else "whole"

    def coarse_copy(self, reach: "Reach") -> CoarseCopy | None:
        """Prepare a coarse copy of what patches show; None where they show triangles of the scan themselves."""
        if reach.coarse_edge is None:
            return None
        wider = self.cut_out(reach, _PATCHES * reach.patch_length, None)
        return CoarseCopy(self.region, wider, reach.coarse_edge)

    def cut_out(self, reach: "Reach", beyond: float, obstacles: Triangles | None) -> Region:
        """Cut out what lies around its places, and so far beyond (mesh units)."""
        mesh = self.region.whole
        if not len(self.sites):
            return Region.all_of(mesh)
        radii = np.concatenate([self.radii, np.full(len(self.sites), self.room)])
        centres = np.concatenate([self.centres, self.sites])
        return region_around(mesh, reach.edges, centres, radii + beyond, obstacles)

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
    coarse_edge : float or None
        Edges of the copy that patches are cut from; None where they are cut from the scan itself.
    """

    diameter: float
    patch_length: float
    edges: EdgeStatistics
    coarse_edge: float | None = None


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
    rim, starts = np.concatenate(loops), laid_out(loops)[0][:-1]
    low, high = (bound.reduceat(mesh.vertices[rim], starts, axis=0) for bound in (np.minimum, np.maximum))
    sizes = np.linalg.norm(high - low, axis=1)
    around = _RINGS * reach.edges.mean + (0.0 if reach.coarse_edge else _PATCHES * reach.patch_length)
    room = _ROOM * (reach.diameter / 2 + MARGIN_EDGES * reach.edges.mean) + around
    sites = pick_sites(mesh, rim, room, MAX_HOLES, rng)
    if len(sites) < MAX_HOLES:
        return RepairRegion.all_of(mesh, len(loops))
    centres, radii = (low + high) / 2, (0.5 + _BULGE) * sizes + around
    part = RepairRegion(Region.all_of(mesh), centres, radii, sites, room)
    region = part.cut_out(reach, 0.0, obstacles)
    return replace(part, region=region) if region.mesh is not mesh else RepairRegion.all_of(mesh, len(loops))
