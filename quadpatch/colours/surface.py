"""A surface whose vertices have colours, but for those in gaps."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.mesh.harmonic import extend_harmonically
from quadpatch.mesh.normals import vertex_normals
from quadpatch.mesh.topology import compacted, directed_edges
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh


@dataclass(frozen=True)
class ColouredSurface:
    """A surface with gaps in its colours.

    Attributes
    ----------
    mesh : TriangleMesh
    colours : (n_vertices, c) float64
        0..255; harmonic in gaps.
    gap : (n_vertices,) int64
        Number of the gap that each vertex lies in, -1 where the colour was measured.
    n_gaps : int
    edge_length : float
        Mean of the mesh, in mesh units.
    """

    mesh: TriangleMesh
    colours: FloatArray
    gap: IntArray
    n_gaps: int
    edge_length: float

    @classmethod
    def of_measured(
        cls, mesh: TriangleMesh, colours: FloatArray, gap: IntArray, n_gaps: int, edge_length: float
    ) -> "ColouredSurface":
        """Fill the gaps in colours (n_vertices, c) harmonically; what stands there is not read."""
        touched = (gap[mesh.triangles] >= 0).any(axis=1)
        used, local = compacted(mesh.triangles[touched], len(gap))
        known = gap[used] < 0
        extended = extend_harmonically(directed_edges(local), known, colours[used])
        whole = colours.copy()
        # A gap without a measured vertex beside it has no colour to take.
        whole[used[~known]] = np.nan_to_num(extended[~known])
        return cls(mesh, whole, gap, n_gaps, edge_length)

    @property
    def is_measured(self) -> BoolArray:
        """Triangles (n_triangles,) whose three corners have a measured colour."""
        return np.asarray((self.gap[self.mesh.triangles] < 0).all(axis=1))

    @cached_property
    def measured_vertices(self) -> IntArray:
        """Vertices (k,) of measured triangles, ascending."""
        return compacted(self.mesh.triangles[self.is_measured], len(self.gap))[0]

    @cached_property
    def measured_tree(self) -> cKDTree:
        """Of the positions of `measured_vertices`."""
        return cKDTree(self.mesh.vertices[self.measured_vertices])

    @cached_property
    def normals(self) -> FloatArray:
        """Unit normals (n_vertices, 3)."""
        return vertex_normals(self.mesh.vertices, self.mesh.triangles)

    @cached_property
    def roughness(self) -> FloatArray:
        """Mean squared difference (n_vertices,) of colours along the measured edges at a vertex; NaN without any."""
        edges = directed_edges(self.mesh.triangles[self.is_measured])
        squared = ((self.colours[edges[:, 0]] - self.colours[edges[:, 1]]) ** 2).sum(axis=1)
        n, ends = len(self.gap), edges.ravel()
        count = np.bincount(ends, minlength=n)
        total = np.bincount(ends, np.repeat(squared, 2), minlength=n)
        return np.asarray(np.divide(total, count, out=np.full(n, np.nan), where=count > 0))
