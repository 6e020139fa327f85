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
from quadpatch.filling.banded_solver import EliminationOrder, UpperPart
from quadpatch.mesh.normals import cross, length
from quadpatch.mesh.topology import directed_edges
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

# Cotangents beyond this come from slivers and would drown every other weight.
_MAX_COTANGENT = 50.0


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
    return FairingEquations(vertices, triangles, free, uniform=uniform).minimise(energy)


class FairingEquations:
    """The equations of every energy on one shape; what energies have in common is computed once.

    Parameters
    ----------
    vertices, triangles, free, uniform
        As for `fair`.
    order : EliminationOrder, optional
        That of an earlier shape of the same triangles.
    unit_area : float, optional
        Area whose square root is the unit of lengths in energies, in mesh units squared; without, the mean area at the
        free vertices.

    Attributes
    ----------
    order : EliminationOrder
        In which vertices are eliminated; fit for all energies on these triangles.
    """

    def __init__(
        self,
        vertices: Vertices,
        triangles: Triangles,
        free: BoolArray,
        *,
        uniform: bool = False,
        order: EliminationOrder | None = None,
        unit_area: float | None = None,
    ) -> None:
        self._vertices, self._free = vertices, free
        self.order = EliminationOrder.of(_links(triangles, free)) if order is None else order
        self._n_fixed = int((~free).sum())
        if not free.any():
            return
        # Fixed vertices first, then the free ones as they are eliminated.
        number = np.empty(len(free), np.int64)
        number[~free] = np.arange(self._n_fixed)
        number[free] = self._n_fixed + self.order.position
        self._numbered = np.empty_like(vertices)
        self._numbered[number] = vertices
        self._triangles, self._is_uniform = number[triangles], uniform
        self._laplacian, area = _laplacian(self._numbered, self._triangles, uniform=uniform)
        unit = area[self._n_fixed :].mean() if unit_area is None else unit_area
        self._inverse_area = sparse.diags_array(unit / area)
        self._powers: dict[float, _Powers] = {}
        self._terms: dict[tuple[float, int], _Term] = {}

    def minimise(self, energy: Energy) -> Vertices:
        """Return the vertices (n, 3) of least energy, as `fair` does."""
        result = self._vertices.copy()
        if not self._free.any():
            return result
        weights = (energy.membrane, energy.plate, energy.variation)
        terms = [(weight, self._term(energy.slope, power)) for power, weight in enumerate(weights) if weight]
        right = np.zeros((len(self._free) - self._n_fixed, 3))
        for weight, term in terms:
            right -= weight * term.fixed_part
        try:
            solution = self.order.solve([(weight, term.matrix) for weight, term in terms], right)
        except RuntimeError as error:
            raise StageError("the surface around a hole is so small that its areas vanish in float64") from error
        result[self._free] = solution[self.order.position]
        return result

    def _term(self, slope: float, power: int) -> "_Term":
        if (slope, power) not in self._terms:
            columns, n = sparse.csc_array(self._powers_of(slope).rows(power)), self._n_fixed
            fixed_part = np.asarray(columns[:, :n] @ self._numbered[:n])
            self._terms[slope, power] = _Term(self.order.upper_part(columns[:, n:]), fixed_part)
        return self._terms[slope, power]

    def _powers_of(self, slope: float) -> "_Powers":
        if slope not in self._powers:
            laplacian = self._laplacian
            if slope != 1.0:
                # At a rim, curvature is how the slopes on both sides differ; the measured one counts for more.
                measured = self._triangles[(self._triangles < self._n_fixed).all(axis=1)]
                of_measured = _laplacian(self._numbered, measured, uniform=self._is_uniform)[0]
                laplacian = sparse.csr_array(laplacian + (slope - 1.0) * of_measured)
            # Rows of free vertices only: those of the outermost ring have lost triangles at the cut.
            rows = sparse.csr_array(laplacian[self._n_fixed :])
            self._powers[slope] = _Powers([rows], sparse.csr_array(self._inverse_area @ laplacian))
        return self._powers[slope]


@dataclass(frozen=True)
class _Powers:
    """Rows of the free vertices of ``L``, ``L M^-1 L`` and ``L M^-1 L M^-1 L``, as far as they were asked for."""

    known: list["sparse.csr_array[np.float64]"]
    step: "sparse.csr_array[np.float64]"

    def rows(self, power: int) -> "sparse.csr_array[np.float64]":
        """Multiply as often as needed."""
        while len(self.known) <= power:
            self.known.append(self.known[-1] @ self.step)
        return self.known[power]


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


def _links(triangles: Triangles, free: BoolArray) -> "sparse.csr_array[np.float64]":
    """Find which free vertices the widest term links: up to three edges apart, whatever shape the triangles have.

    The term itself would not do: a link may have the weight 0 in one shape, and another one in the next.
    """
    n, (start, end) = len(free), directed_edges(triangles).T
    edges = sparse.csr_array((np.ones(len(start)), (start, end)), shape=(n, n))
    step = sparse.csr_array(edges + edges.T + sparse.eye_array(n))
    return sparse.csr_array((step[free] @ step @ step)[:, free])


def _laplacian(vertices: Vertices, triangles: Triangles, *, uniform: bool) -> tuple[sparse.csr_array, FloatArray]:
    """Cotangent (or graph) Laplacian (n, n), rows summing to zero, and vertex areas (n,)."""
    n = len(vertices)
    corners = vertices[triangles]
    double_area = length(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    weight = np.full((len(triangles), 3), 0.5) if uniform else 0.5 * _cotangents(corners, double_area)
    rows, columns, weights = [], [], []
    for k in range(3):
        i, j = triangles[:, (k + 1) % 3], triangles[:, (k + 2) % 3]
        rows += [i, j]
        columns += [j, i]
        weights += [weight[:, k], weight[:, k]]
    adjacency = sparse.csr_array(
        (np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns))), shape=(n, n)
    )
    laplacian = sparse.csr_array(sparse.diags_array(adjacency.sum(axis=1)) - adjacency)
    if uniform:
        return laplacian, np.ones(n)
    area = np.asarray(np.bincount(triangles.ravel(), np.repeat(double_area / 6, 3), minlength=n), np.float64)
    return laplacian, np.maximum(area, 1e-6 * area[area > 0].mean())


def _cotangents(corners: FloatArray, double_area: FloatArray) -> FloatArray:
    """Cotangents (m, 3) at the corners (m, 3, 3) of triangles; those of a sliver are scaled down together.

    Cut off one by one, the large weights of a sliver would no longer cancel out, and one needle at a rim would crumple
    the fill.
    """
    tiny = 1e-12 * double_area.mean() + 1e-300
    cotangents = np.zeros((len(corners), 3))
    for k in range(3):
        u, v = corners[:, (k + 1) % 3] - corners[:, k], corners[:, (k + 2) % 3] - corners[:, k]
        cotangents[:, k] = np.einsum("ij,ij->i", u, v) / np.maximum(double_area, tiny)
    largest = np.abs(cotangents).max(axis=1, keepdims=True, initial=0.0)
    return np.asarray(cotangents * (_MAX_COTANGENT / np.maximum(largest, _MAX_COTANGENT)))


def triangles_around(triangles: Triangles, core: IntArray, n_vertices: int, n_rings: int) -> IntArray:
    """Triangles with a corner among `core` or less than `n_rings` rings away from it: indices (k,) int64, ascending."""
    inside = np.zeros(n_vertices, bool)
    inside[core] = True
    touched = np.zeros(len(triangles), bool)
    for _ in range(n_rings):
        touched = np.asarray(inside[triangles].any(axis=1))
        inside[triangles[touched]] = True
    return np.flatnonzero(touched)
