"""How far each energy misses the rims of holes: leave-one-out residuals of the surface around them.

The vertices of a rim are measured. Let go, they move with the fill to where the surface has least energy: how far that
surface then passes from where they were measured says which energy carries on this very surface.

References
----------
M. Stone, "Cross-validatory choice and assessment of statistical predictions", Journal of the Royal Statistical Society
B 36, 1974.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quadpatch.errors import StageError
from quadpatch.filling.fairing import Energy, FairingEquations, triangles_around
from quadpatch.filling.fill import ClosedMesh, unit_area
from quadpatch.filling.laplacian import Connectivity
from quadpatch.mesh.averages import mean_by
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.edge_groups import group_edges
from quadpatch.mesh.topology import compacted, touching
from quadpatch.progress import Fraction, no_fraction
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# Around rims that move: the minimum variation surface reads one ring more than around rims that stay.
_RINGS = 3
# Fewer vertices behind a rim hold no plane.
_LEAST_BEHIND = 3


def rim_residuals(closed: ClosedMesh, energies: Sequence[Energy], reach: Fraction = no_fraction) -> FloatArray:
    """Let the rims of closed holes go, and measure by how much each energy misses the vertices that were there.

    Parameters
    ----------
    closed : ClosedMesh
    energies : sequence of Energy
    reach : callable
        Told the done fraction.

    Returns
    -------
    (n_holes, n_energies) float64
        Mean distance, in mesh units; NaN for a hole without a fill, one whose rim lies next to a border or has no
        surface behind it, and one whose rim passes a vertex twice: joined to an island, it says nothing about the
        surface between the two.
    """
    misses = np.full((closed.n_holes, len(energies)), np.nan)
    around = _Around.of(closed)
    rim, hole = around.rims_with_surface_behind(closed)
    if not len(rim):
        return misses
    free = around.is_new.copy()
    free[rim] = True
    equations = FairingEquations(
        around.vertices, Connectivity(around.triangles, free), unit_area=unit_area(closed.plate)
    )
    surface = around.triangles[touching(around.triangles, free)]
    for number, energy in enumerate(energies):
        try:
            vertices = equations.minimise(energy)
        except StageError:
            # The areas around one of the rims vanish: calibration alone chooses then.
            return np.full_like(misses, np.nan)
        distance = distance_to_mesh(around.vertices[rim], TriangleMesh(vertices, surface))
        misses[np.unique(hole), number] = mean_by(hole, distance, closed.n_holes)[np.unique(hole)]
        reach((number + 1) / len(energies))
    return misses


@dataclass(frozen=True)
class _Around:
    """Closed holes and the measured surface around them, in vertices of their own.

    Attributes
    ----------
    vertices : (n, 3) float64
    triangles : (m, 3) int64
    is_new : (n,) bool
    rim, hole : (k,) int64
        Vertices of the rims, and the position of each one's hole.
    """

    vertices: Vertices
    triangles: Triangles
    is_new: BoolArray
    rim: IntArray
    hole: IntArray

    @classmethod
    def of(cls, closed: ClosedMesh) -> "_Around":
        near, mesh, plate = closed.near, closed.mesh, closed.plate
        hole = np.repeat(np.arange(closed.n_holes), [len(loop) for loop in near.loops])
        rim = near.used[np.concatenate([np.zeros(0, np.int64), *near.loops])]
        chosen = triangles_around(mesh.triangles, rim, len(mesh.vertices), _RINGS)
        used, measured = compacted(mesh.triangles[chosen], len(mesh.vertices))
        n_new = len(plate.vertices) - plate.n_measured
        to_here = np.concatenate([np.searchsorted(used, near.used), len(used) + np.arange(n_new)])
        vertices = np.concatenate([mesh.vertices[used] - near.centre, plate.vertices[plate.n_measured :]])
        triangles = np.concatenate([measured, to_here[plate.triangles]])
        return cls(vertices, triangles, np.arange(len(vertices)) >= len(used), np.searchsorted(used, rim), hole)

    def rims_with_surface_behind(self, closed: ClosedMesh) -> tuple[IntArray, IntArray]:
        """Choose the rims that can be let go: their vertices (j,), and the hole of each."""
        is_kept = np.array([len(np.unique(loop)) == len(loop) for loop in closed.near.loops], bool)
        is_kept[closed.unfilled] = False
        at_rim = np.full(len(self.vertices), -1)
        at_rim[self.rim] = self.hole
        corners = self.triangles[touching(self.triangles, at_rim >= 0)]
        hole = at_rim[corners].max(axis=1)
        # Of vertices one ring away from a rim all triangles are here, so an edge with one of them is at a border.
        edges = group_edges(self.triangles, len(self.vertices))
        at_border = np.zeros(len(self.vertices), bool)
        at_border[edges.ends()[edges.count == 1]] = True
        is_kept[hole[at_border[corners].any(axis=1)]] = False
        is_behind = (at_rim[corners] < 0) & ~self.is_new[corners]
        behind = np.unique(np.stack([np.repeat(hole, 3), corners.ravel()], axis=1)[is_behind.ravel()], axis=0)
        is_kept &= np.bincount(behind[:, 0], minlength=closed.n_holes) >= _LEAST_BEHIND
        chosen = is_kept[self.hole]
        return self.rim[chosen], self.hole[chosen]
