r"""The vertices of gaps as a graph, and what detail costs and brings there.

Colours of a gap are the harmonic ones plus a detail that vanishes at the rim. Detail of an exemplar :math:`s` solves

.. math:: (L + \kappa D)\, d = \mathrm{div}\,\nabla s

with the graph Laplacian :math:`L`, the degrees :math:`D` and colours fixed at the rim. Without screening, :math:`\kappa
= 0`, that is the Poisson solve of Pérez et al.: the gradients are those of the exemplar, the rim is met without a seam.
Screening (Bhat et al.) leaves out what is coarser than about :math:`\kappa^{-1/2}` edges: an exemplar rarely knows the
coarse shades of what was lost, and detail that is not true costs its square.

Harmonic colours and detail are orthogonal in the energy :math:`\sum_{ij} (u_i - u_j)^2`, so that of their sum is the
sum of both.

References
----------
P. Pérez, M. Gangnet, A. Blake, "Poisson image editing", SIGGRAPH 2003.
P. Bhat, B. Curless, M. Cohen, C. L. Zitnick, "Fourier analysis of the 2D screened Poisson equation for gradient domain
problems", ECCV 2008.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csc_array, diags_array
from scipy.sparse.linalg import splu

from quadpatch.colours.surface import ColouredSurface
from quadpatch.mesh.topology import directed_edges
from quadpatch.types import BoolArray, FloatArray, IntArray


@dataclass(frozen=True)
class GapGraph:
    """Vertices of some gaps, and the edges at them.

    Attributes
    ----------
    vertices : (n,) int64
        Of the surface, ascending.
    gap : (n,) int64
        Which gap each lies in.
    start : (e,) int64
        Position in `vertices` of where each edge starts; one direction for edges to the rim, both for others.
    end : (e,) int64
        Vertex of the surface.
    inner_end : (e,) int64
        Position in `vertices`, -1 on the rim.
    """

    vertices: IntArray
    gap: IntArray
    start: IntArray
    end: IntArray
    inner_end: IntArray

    @classmethod
    def of_gaps(cls, surface: ColouredSurface, first: int, stop: int) -> "GapGraph":
        """Take the gaps of numbers from `first` to below `stop`."""
        inside = (surface.gap >= first) & (surface.gap < stop)
        edges = directed_edges(surface.mesh.triangles[inside[surface.mesh.triangles].any(axis=1)])
        both = np.concatenate([edges, edges[:, ::-1]])
        edges = np.unique(both[inside[both[:, 0]]], axis=0)
        vertices = np.flatnonzero(inside)
        number = np.full(len(inside), -1)
        number[vertices] = np.arange(len(vertices))
        return cls(vertices, surface.gap[vertices], number[edges[:, 0]], edges[:, 1], number[edges[:, 1]])

    def solver(self, screening: float, joined: BoolArray | None = None) -> Callable[[FloatArray], FloatArray]:
        """Prepare to solve for details that vanish at the rim.

        Parameters
        ----------
        screening : float
        joined : (e,) bool, optional
            Edges that tie their ends together; over others detail vanishes as at a rim.

        Returns
        -------
        callable
            From the divergence (n, k) of the wanted gradients to details (n, k).
        """
        n, tied = len(self.vertices), self.inner_end >= 0
        tied = tied if joined is None else tied & joined
        degree = np.bincount(self.start, minlength=n).astype(np.float64)
        off = coo_array((-np.ones(int(tied.sum())), (self.start[tied], self.inner_end[tied])), shape=(n, n))
        matrix = csc_array(diags_array((1.0 + screening) * degree) + off)
        factors = splu(matrix, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
        return lambda right: np.asarray(factors.solve(np.ascontiguousarray(right)))

    def energy(self, inner: FloatArray, rim: FloatArray | None = None, joined: BoolArray | None = None) -> FloatArray:
        """Sum up squared differences along the edges.

        Parameters
        ----------
        inner : (n, k) float64
        rim : (n_surface_vertices, k) float64, optional
            What stands at the rim; else 0.
        joined : (e,) bool, optional
            Edges whose other end counts as rim where False.

        Returns
        -------
        (n,) float64
            Half of each edge at either of its inner vertices.
        """
        tied = self.inner_end >= 0 if joined is None else (self.inner_end >= 0) & joined
        other = np.where(tied[:, np.newaxis], inner[self.inner_end], 0.0 if rim is None else rim[self.end])
        squared = ((inner[self.start] - other) ** 2).sum(axis=1)
        return np.asarray(np.bincount(self.start, np.where(tied, 0.5, 1.0) * squared, minlength=len(self.vertices)))
