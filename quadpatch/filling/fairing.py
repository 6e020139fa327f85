"""Fairing: the smoothest surface that continues the one around the hole.

New vertices minimise an energy of the surface while every measured vertex stays where it is. The thin plate
minimises curvature, ``L M^-1 L x = 0`` with L the cotangent Laplacian and M the vertex areas; the minimum variation
surface minimises the change of curvature, ``L M^-1 L M^-1 L x = 0``, and so carries the curvature of the rim on into
the hole. The first needs two rings of measured vertices at the rim, the second three. The smoother the energy, the
better it continues a smooth surface and the worse a rough one, whose noise at the rim it magnifies: `Energy` blends
them.

References
----------
M. Botsch, L. Kobbelt, "An intuitive framework for real-time freeform modeling", ACM SIGGRAPH, 2004.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from quadpatch.errors import StageError
from quadpatch.filling.banded_solver import UpperPart
from quadpatch.filling.laplacian import Connectivity, cotangent_weights
from quadpatch.mesh.topology import touching
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices


@dataclass(frozen=True)
class Energy:
    """Weights of membrane (area), thin plate (curvature) and minimum variation (change of curvature).

    Without unit: lengths in them are mean edge lengths of the fill.

    `slope` is how many times as steep as the measured surface the fill leaves the rim, before the energy levels it out.
    On most scans a thin plate bulges too little over the middle of a hole; a larger slope makes it bulge more.
    """

    membrane: float = 0.0
    plate: float = 0.0
    variation: float = 0.0
    slope: float = 1.0


THIN_PLATE = Energy(plate=1.0)


def fair(
    vertices: Vertices, triangles: Triangles, free: BoolArray, energy: Energy, *, uniform: bool = False
) -> Vertices:
    """Move the free vertices to where the surface has least energy.

    Parameters
    ----------
    vertices : (n, 3) float64
    triangles : (m, 3) int64
        The fill and, around its rim, as many rings of triangles as the energy reads, plus one.
    free : (n,) bool
        Vertices that may move.
    energy : Energy
    uniform : bool
        The graph Laplacian in place of the cotangent one: for a start too crumpled to take weights from.

    Returns
    -------
    (n, 3) float64
        A copy; fixed vertices keep their bits.

    Raises
    ------
    StageError
        If all triangles around a free vertex are too small to have an area.
    """
    return FairingEquations(vertices, Connectivity(triangles, free), uniform=uniform).minimise(energy)


class FairingEquations:
    """The equations of every energy on one shape; what energies have in common is computed once.

    Parameters
    ----------
    vertices : (n, 3) float64
    connectivity : Connectivity
        Of its triangles: those of the fill and around its rim, as for `fair`.
    uniform : bool
        As for `fair`.
    unit_area : float, optional
        Area whose square root is the unit of lengths in energies, in mesh units squared; without, the mean area at the
        free vertices.
    """

    def __init__(
        self,
        vertices: Vertices,
        connectivity: Connectivity,
        *,
        uniform: bool = False,
        unit_area: float | None = None,
    ) -> None:
        self._vertices, self.connectivity = vertices, connectivity
        if not connectivity.free.any():
            return
        triangles, n_fixed = connectivity.triangles, connectivity.n_fixed
        if uniform:
            self._weights, area = np.full((len(triangles), 3), 0.5), np.ones(len(vertices))
        else:
            self._weights, area = cotangent_weights(vertices, triangles)
        area = area[connectivity.place]
        self._inverse_area = (area[n_fixed:].mean() if unit_area is None else unit_area) / area
        self._fixed_places = vertices[connectivity.place]
        self._fixed_places[n_fixed:] = 0.0
        self._powers: dict[float, _Powers] = {}
        self._terms: dict[tuple[float, int], _Term] = {}

    def minimise(self, energy: Energy) -> Vertices:
        """Return the vertices (n, 3) of least energy, as `fair` does."""
        result, connectivity = self._vertices.copy(), self.connectivity
        if not connectivity.free.any():
            return result
        weights = (energy.membrane, energy.plate, energy.variation)
        # The widest first: the others are steps on the way to it.
        used = [power for power in (2, 1, 0) if weights[power]]
        terms = [(weights[power], self._term(energy.slope, power)) for power in used]
        right = np.zeros((len(result) - connectivity.n_fixed, 3))
        for weight, term in terms:
            right -= weight * term.fixed_part
        try:
            solution = connectivity.order.solve([(weight, term.matrix) for weight, term in terms], right)
        except RuntimeError as error:
            raise StageError("the surface around a hole is so small that its areas vanish in float64") from error
        result[connectivity.place[connectivity.n_fixed :]] = solution
        return result

    def _term(self, slope: float, power: int) -> "_Term":
        if (slope, power) not in self._terms:
            powers, n_fixed = self._powers_of(slope), self.connectivity.n_fixed
            fixed_part = self._fixed_places
            for _ in range(power):
                fixed_part = powers.step @ fixed_part
            matrix = self.connectivity.order.upper_part(powers.of_free(power, n_fixed))
            self._terms[slope, power] = _Term(matrix, powers.known[0] @ fixed_part)
        return self._terms[slope, power]

    def _powers_of(self, slope: float) -> "_Powers":
        if slope not in self._powers:
            connectivity, weights = self.connectivity, self._weights
            if slope != 1.0:
                # At a rim, curvature is how the slopes on both sides differ; the measured one counts for more.
                is_measured = ~touching(connectivity.triangles, connectivity.free)
                weights = np.where(is_measured[:, None], slope, 1.0) * weights
            laplacian = connectivity.laplacian(weights)
            step = laplacian.copy()
            step.data *= np.repeat(self._inverse_area, np.diff(step.indptr))
            # Rows of free vertices only: those of the outermost ring have lost triangles at the cut.
            rows, n_fixed = sparse.csr_array(laplacian[connectivity.n_fixed :]), connectivity.n_fixed
            self._powers[slope] = _Powers([rows], step, sparse.csr_array(step[:, n_fixed:]))
        return self._powers[slope]


@dataclass(frozen=True)
class _Powers:
    """Rows of the free vertices of ``L``, ``L M^-1 L`` and ``L M^-1 L M^-1 L``, as far as they were asked for.

    Attributes
    ----------
    known : list of (n_free, n) sparse float64
    step : (n, n) sparse float64
        ``M^-1 L``
    to_free : (n, n_free) sparse float64
        Its columns of free vertices.
    """

    known: list["sparse.csr_array[np.float64]"]
    step: "sparse.csr_array[np.float64]"
    to_free: "sparse.csr_array[np.float64]"

    def of_free(self, power: int, n_fixed: int) -> "sparse.csr_array[np.float64]":
        """Give the columns (n_free, n_free) of free vertices; multiply as often as needed."""
        if len(self.known) > power:
            return sparse.csr_array(self.known[power][:, n_fixed:])
        while len(self.known) < power:
            self.known.append(self.known[-1] @ self.step)
        return sparse.csr_array(self.known[power - 1] @ self.to_free)


@dataclass(frozen=True)
class _Term:
    """One of the three terms of an energy.

    Attributes
    ----------
    matrix : UpperPart
        Of the free vertices, as they are eliminated.
    fixed_part : (n_free, 3) float64
        What the fixed vertices add.
    """

    matrix: UpperPart
    fixed_part: FloatArray


def triangles_around(triangles: Triangles, core: IntArray, n_vertices: int, n_rings: int) -> IntArray:
    """Triangles with a corner among `core` or less than `n_rings` rings away from it: indices (k,) int64, ascending."""
    inside = np.zeros(n_vertices, bool)
    inside[core] = True
    touched = np.zeros(len(triangles), bool)
    for _ in range(n_rings):
        touched = touching(triangles, inside)
        inside[triangles[touched]] = True
    return np.flatnonzero(touched)
