"""The surfaces that patches are cut from: one with the holes filled, one with the calibration holes filled.

Where bins are wider than triangles, a patch can't show what the triangles do: it is cut from a coarse copy, whose
edges are as long as those of a scan for which such bins are chosen.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.region import Region
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.patches.layout import Sampled, sample_over_base
from quadpatch.patches.scale import PatchScale, base_surface_iterations
from quadpatch.patches.seeds import Seeds
from quadpatch.quads.vertex_clustering import Clusters, cluster
from quadpatch.types import BoolArray, IntArray, TriangleMesh, Triangles, Vertices


@dataclass(frozen=True)
class PatchSurface:
    """A surface that patches are cut from.

    Attributes
    ----------
    mesh : TriangleMesh
    invented : (n_triangles,) bool
        True for the triangles that were not measured.
    cut_away : (n_triangles,) bool
        Measured triangles that calibration holes took.
    edge_length : float
        Mean of the mesh, in mesh units.
    """

    mesh: TriangleMesh
    invented: BoolArray
    cut_away: BoolArray
    edge_length: float

    @property
    def undamaged(self) -> TriangleMesh:
        """What was measured, without what calibration holes took."""
        return TriangleMesh(self.mesh.vertices, self.mesh.triangles[~(self.invented | self.cut_away)])

    def smoothed(self, scale: PatchScale) -> TriangleMesh:
        """Smooth it as far as patches are wide: the base surface."""
        return laplacian_smooth(self.mesh, base_surface_iterations(scale.length, self.edge_length))

    def patchify(self, base_surface: TriangleMesh, seeds: Seeds, scale: PatchScale) -> Sampled:
        """Sample it, and its base surface, in the patches at some seeds."""
        return sample_over_base(self.mesh, self.invented, base_surface, seeds, scale)


@dataclass(frozen=True)
class PatchSurfaces:
    """Both surfaces; `calibration` is None without calibration holes."""

    filled: PatchSurface
    calibration: PatchSurface | None

    @classmethod
    def of_scan(
        cls, filled: FilledMesh, cut_away: BoolArray | None, calibration: FilledMesh | None, edge_length: float
    ) -> "PatchSurfaces":
        """Take the triangles as they are.

        Parameters
        ----------
        filled : FilledMesh
            With fills of the holes.
        cut_away : (n_measured_triangles,) bool, optional
            What calibration holes took.
        calibration : FilledMesh, optional
            The same measured vertices, with fills of the calibration holes.
        edge_length : float
            Mean of the scan, in mesh units.
        """
        hidden = np.zeros(len(filled.mesh.triangles), bool)
        if cut_away is not None:
            hidden[: len(cut_away)] = cut_away
        surface = PatchSurface(filled.mesh, filled.invented_triangles, hidden, edge_length)
        if calibration is None:
            return cls(surface, None)
        nothing = np.zeros(len(calibration.mesh.triangles), bool)
        return cls(surface, PatchSurface(calibration.mesh, calibration.invented_triangles, nothing, edge_length))


@dataclass(frozen=True)
class CoarseCopy:
    """How coarse copies are made.

    Attributes
    ----------
    filled_region : Region
        Part of the scan that holes were filled in.
    region : Region
        The larger part that patches show.
    cell : float
        Vertices within one cell of a grid are joined; its side in mesh units.
    """

    filled_region: Region
    region: Region
    cell: float

    def surfaces(self, filled: FilledMesh, removed: BoolArray | None, calibration: FilledMesh | None) -> PatchSurfaces:
        """Make coarse copies of both surfaces, which are the same where neither was filled.

        Parameters
        ----------
        filled : FilledMesh
            The smaller region, with fills of the holes.
        removed : (n_measured_vertices,) bool, optional
            Vertices of the smaller region that calibration holes took.
        calibration : FilledMesh, optional
            The smaller region, with fills of the calibration holes.
        """
        measured = self.region.mesh
        is_removed = np.zeros(len(measured.vertices), bool)
        if removed is not None:
            is_removed[self._in_region(np.flatnonzero(removed))] = True
        fills = [fill for fill in (filled, calibration) if fill is not None]
        vertices, new_triangles = self._joined(fills)
        # What was measured, taken away or invented is never joined with what is not.
        counts = [len(fill.mesh.vertices) - fill.n_measured_vertices for fill in fills]
        kind = np.concatenate([is_removed.astype(np.int64), np.repeat(np.arange(2, 2 + len(fills)), counts)])
        everything = TriangleMesh(vertices, np.concatenate([measured.triangles, *new_triangles]))
        clusters = cluster(everything, self.cell, kind)
        remaining = measured.triangles[clusters.spanning(measured.triangles)]
        cut = np.asarray(is_removed[remaining].any(axis=1))
        surface = _coarse(clusters, remaining, cut, new_triangles[0])
        if calibration is None:
            return PatchSurfaces(surface, None)
        nothing = np.zeros(int((~cut).sum()), bool)
        return PatchSurfaces(surface, _coarse(clusters, remaining[~cut], nothing, new_triangles[1]))

    def _in_region(self, indices: IntArray) -> IntArray:
        return self.region.local(self.filled_region.vertices[indices])

    def _joined(self, fills: Sequence[FilledMesh]) -> tuple[Vertices, list[Triangles]]:
        """Vertices of the region, and behind them those of some fills, whose triangles come back in these."""
        vertices, triangles = [self.region.mesh.vertices], list[Triangles]()
        n = len(vertices[0])
        to_region = self._in_region(np.arange(len(self.filled_region.vertices)))
        for fill in fills:
            new = fill.mesh.vertices[fill.n_measured_vertices :]
            translated = np.concatenate([to_region, n + np.arange(len(new))])
            vertices.append(new)
            triangles.append(translated[fill.mesh.triangles[fill.n_measured_triangles :]])
            n += len(new)
        return np.concatenate(vertices), triangles


def _coarse(clusters: Clusters, measured: Triangles, cut_away: BoolArray, invented: Triangles) -> PatchSurface:
    triangles, source = clusters.join(np.concatenate([measured, invented]))
    is_invented = source >= len(measured)
    is_cut = np.zeros(len(source), bool)
    is_cut[~is_invented] = cut_away[source[~is_invented]]
    mesh = TriangleMesh(clusters.vertices, triangles)
    return PatchSurface(mesh, is_invented, is_cut, mean_edge_length(mesh))
