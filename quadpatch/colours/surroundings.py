"""The part of a filled scan that its new colours depend on: the surroundings of its fills, and places to calibrate at.

A scan ten times as large has no more of it (see `quadpatch.recipes.repair_region`, which does the same for shape).
"""

from dataclasses import dataclass, replace

import numpy as np

from quadpatch.calibration.calibration_set import MARGIN_EDGES, MAX_HOLES
from quadpatch.calibration.sites import pick_sites
from quadpatch.colours.cells import MARGIN, WIDEST_CELL
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.region import Region, region_around
from quadpatch.mesh.measures import EdgeStatistics
from quadpatch.types import FloatArray, TriangleMesh

# Sources lie in what is left around a fill, or a calibration hole, within so many patch lengths.
_PATCHES = 1.5


@dataclass(frozen=True)
class Surroundings:
    """Part of a filled mesh.

    Attributes
    ----------
    filled : FilledMesh
        Its new vertices and triangles are those of the whole, in the same order.
    region : Region
        Where it lies in the whole filled mesh.
    """

    filled: FilledMesh
    region: Region

    @classmethod
    def of_fills(
        cls, filled: FilledMesh, edges: EdgeStatistics, rng: np.random.Generator, spacing: float | None = None
    ) -> "Surroundings":
        """Cut out what lies around the fills, and places for calibration; the whole where there are too few places.

        Parameters
        ----------
        filled : FilledMesh
        edges : EdgeStatistics
            Of the scan.
        rng : numpy.random.Generator
        spacing : float, optional
            Mean distance of places that have a colour, in mesh units; without, that of the vertices.
        """
        spacing = edges.mean if spacing is None else spacing
        centres, radii = _balls(filled)
        if not len(centres):
            return cls(filled, Region.all_of(filled.mesh))
        cell = min(float(np.percentile(radii, 75)), WIDEST_CELL * spacing)
        around = _PATCHES * 2 * (cell + MARGIN * spacing)
        room = cell + MARGIN_EDGES * spacing + around
        new = filled.mesh.triangles[filled.n_measured_triangles :]
        rim = np.unique(new[new < filled.n_measured_vertices])
        sites = pick_sites(filled.measured, rim, room, MAX_HOLES, rng)
        if len(sites) < MAX_HOLES:
            return cls(filled, Region.all_of(filled.mesh))
        everywhere = np.concatenate([centres, sites]), np.concatenate([radii + around, np.full(len(sites), room)])
        region = region_around(filled.mesh, edges, *everywhere, None)
        return cls(_part(filled, region), region)


def _balls(filled: FilledMesh) -> tuple[FloatArray, FloatArray]:
    """Centres (k, 3) and radii (k,) of balls around the fills."""
    new = filled.mesh.triangles[filled.n_measured_triangles :]
    holes, number = np.unique(filled.triangle_hole, return_inverse=True)
    corners, of_corner = filled.mesh.vertices[new.ravel()], np.repeat(number, 3)
    low, high = np.full((len(holes), 3), np.inf), np.full((len(holes), 3), -np.inf)
    np.minimum.at(low, of_corner, corners)
    np.maximum.at(high, of_corner, corners)
    return (low + high) / 2, np.linalg.norm(high - low, axis=1) / 2


def _part(filled: FilledMesh, region: Region) -> FilledMesh:
    if region.mesh is region.whole:
        return filled
    # All that is new lies in the region, and behind what was measured, as in the whole.
    n_new_vertices = len(filled.mesh.vertices) - filled.n_measured_vertices
    n_new_triangles = len(filled.mesh.triangles) - filled.n_measured_triangles
    return replace(
        filled,
        mesh=TriangleMesh(region.mesh.vertices, region.mesh.triangles),
        n_measured_vertices=len(region.mesh.vertices) - n_new_vertices,
        n_measured_triangles=len(region.mesh.triangles) - n_new_triangles,
    )
