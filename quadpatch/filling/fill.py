"""The geometric answer: holes closed, refined and faired.

It is the baseline of learned fills, and has the vertices that they displace.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from quadpatch.filling.fairing import THIN_PLATE, Energy, FairingEquations
from quadpatch.filling.filled_mesh import FilledMesh, rim_diagonals
from quadpatch.filling.laplacian import Connectivity
from quadpatch.filling.refinement import Grading, Refined, refine, relax
from quadpatch.filling.rim_neighbourhood import RimNeighbourhood
from quadpatch.mesh.averages import mean_by
from quadpatch.mesh.normals import area_vectors, length, vertex_areas
from quadpatch.progress import Fraction, no_fraction
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# What the thin plate is compared with to see how far two sensible answers lie apart.
ALTERNATIVE_ENERGY = Energy(plate=1.0, variation=0.4)

# Fill and thin plate of one hole further apart than this share of its width: the fill overshoots.
OVERSHOOT_LIMIT = 0.2

# Area at a vertex of a uniform fill, in squares of the edge length at its rim: 0.32 to 0.51 on scans.
_AREA_OF_VERTEX = 0.42


@dataclass(frozen=True)
class ClosedMesh:
    """Holes triangulated and refined, not faired to their end: what every energy starts from.

    Attributes
    ----------
    near : Surroundings
    plate : Refined
        The thin plate, in local vertices and coordinates.
    equations : FairingEquations
        Of all energies on the plate.
    disagreement : (n_holes,) float64
        Mean distance between a thin plate and a slightly smoother surface, by area, in mesh units: how far two sensible
        answers lie apart says how uncertain a hole is.
    rim_variation : (n_holes,) float64
        Mean length of the difference between the unit normals of neighbouring rim vertices: how rough or bent the
        surface is there.
    unfilled : list of int
    """

    near: RimNeighbourhood
    plate: Refined
    equations: FairingEquations
    disagreement: FloatArray
    rim_variation: FloatArray
    unfilled: list[int]

    @property
    def mesh(self) -> TriangleMesh:
        """The input."""
        return self.near.mesh

    @property
    def n_holes(self) -> int:
        """Number of loops."""
        return len(self.disagreement)

    def coarse(self) -> "ClosedMesh":
        """Close them with fewer vertices far from the rims, where holes are large for their edges."""
        grading = self.near.grading
        return self if grading is self.plate.grading else close_rims(self.near, grading)

    @cached_property
    def filled(self) -> FilledMesh:
        """The mesh, filled by the plate; other energies move its new vertices."""
        return self.near.filled(self.plate, self.unfilled, self.disagreement, self.rim_variation)


def close_holes(mesh: TriangleMesh, loops: list[IntArray], *, graded: bool = False) -> ClosedMesh:
    """Triangulate and refine boundary loops, and lay a thin plate over each.

    Parameters
    ----------
    mesh : TriangleMesh
    loops : list of (n_loop,) int64
        Simple loops with the surface on their left, as `boundary_loops` gives them.
    graded : bool
        Fewer vertices far from the rims: for fills that are measured and thrown away.
    """
    near = RimNeighbourhood.of(mesh, loops).straightened()
    return close_rims(near, near.grading if graded else None)


def close_rims(near: RimNeighbourhood, grading: Grading | None = None) -> ClosedMesh:
    """Close holes, of which the surroundings are known, as `close_holes` does."""
    patch, unfilled = near.triangulation
    patch = replace(patch, grading=grading)
    # A first, crumpled fairing; its bulge makes room for more vertices, and its shape better weights.
    patch = fair_refined(refine(patch, near.edges), near.adjacent_triangles, THIN_PLATE, uniform=True)
    patch = relax(refine(patch, near.edges), near.adjacent_triangles, near.edges)
    patch = near.with_flat_corners(patch)
    equations = equations_of(patch, near.adjacent_triangles)
    plate = replace(patch, vertices=equations.minimise(THIN_PLATE))
    equations = equations_of(plate, near.adjacent_triangles, equations.connectivity)
    # Both on the same shape: else their distance is that from a shape which has not settled.
    both = (equations.minimise(energy) for energy in (THIN_PLATE, ALTERNATIVE_ENERGY))
    disagreement = _mean_by_hole(plate, length(np.subtract(*both)), len(near.loops))
    return ClosedMesh(near, plate, equations, disagreement, near.rim_variation(), unfilled)


def close_flat(mesh: TriangleMesh, loops: list[IntArray]) -> FilledMesh:
    """Triangulate and refine boundary loops and leave it at that: the closing that the paper starts from.

    New vertices lie on the flat triangles that span the rim.

    Parameters
    ----------
    mesh : TriangleMesh
    loops : list of (n_loop,) int64
        Simple loops with the surface on their left, as `boundary_loops` gives them.

    Returns
    -------
    FilledMesh
        Its disagreement and rim variation are NaN: nothing is known of its error.
    """
    near = RimNeighbourhood.of(mesh, loops).straightened()
    patch, unfilled = near.triangulation
    return near.filled(near.with_flat_corners(refine(patch, near.edges)), unfilled)


def fair_holes(closed: ClosedMesh, energy: Energy) -> FilledMesh:
    """Fair all holes by one energy.

    Returns
    -------
    FilledMesh
        The input's vertices and triangles are its bit-exact prefix.
    """
    return fair_by_each(closed, [energy], np.ones((closed.n_holes, 1)))[0]


def fair_by_each(
    closed: ClosedMesh, energies: Sequence[Energy], weights: FloatArray, reach: Fraction = no_fraction
) -> list[FilledMesh]:
    """Fair all holes by each energy: twice, since the equations depend on the shape.

    The shape of the second time is the mean of the first fills, whose equations serve all energies.

    Parameters
    ----------
    closed : ClosedMesh
    energies : sequence of Energy
    weights : (n_holes, n_energies) float64
        Shares of the fills in that mean; rows sum to 1.
    reach : callable
        Told the done fraction.
    """
    plate, n = closed.plate, closed.plate.n_measured
    of_new = weights[closed.filled.vertex_hole]
    shape = plate.vertices.copy()
    shape[n:] = 0.0
    for number, energy in enumerate(energies):
        shape[n:] += of_new[:, number, None] * _without_overshoot(closed, closed.equations.minimise(energy))[n:]
        reach(0.5 * (number + 1) / len(energies))
    equations = equations_of(
        replace(plate, vertices=shape), closed.near.adjacent_triangles, closed.equations.connectivity
    )
    fills = []
    for energy in energies:
        vertices = _without_overshoot(closed, equations.minimise(energy))[n:]
        fills.append(closed.filled.with_vertices(vertices + closed.near.centre))
        reach(0.5 + 0.5 * len(fills) / len(energies))
    return fills


def _without_overshoot(closed: ClosedMesh, vertices: Vertices) -> Vertices:
    """Take the thin plate where curvature that is carried on from a ragged rim runs away."""
    plate, n_holes = closed.plate, closed.n_holes
    hole = _hole_of_new(plate)
    new = hole >= 0
    furthest = np.zeros(n_holes)
    np.maximum.at(furthest, hole[new], np.linalg.norm(vertices - plate.vertices, axis=1)[new])
    runaway = furthest > OVERSHOOT_LIMIT * rim_diagonals(
        plate.vertices, plate.triangles, plate.hole, plate.n_measured, n_holes
    )
    return np.where((new & runaway[hole])[:, None], plate.vertices, vertices)


def _hole_of_new(patch: Refined) -> IntArray:
    """Hole (n,) of every new vertex, -1 for measured ones."""
    hole = np.full(len(patch.vertices), -1)
    hole[patch.triangles] = patch.hole[:, None]
    hole[: patch.n_measured] = -1
    return hole


def _mean_by_hole(patch: Refined, values: FloatArray, n_holes: int) -> FloatArray:
    """Mean (n_holes,) of values (n,) over the new vertices of each hole, by the areas at them; 0 without any."""
    hole, areas = _hole_of_new(patch), vertex_areas(patch.vertices, patch.triangles)
    new = hole >= 0
    return mean_by(hole[new], values[new], n_holes, areas[new])


def equations_of(
    patch: Refined, adjacent_triangles: Triangles, connectivity: Connectivity | None = None, *, uniform: bool = False
) -> FairingEquations:
    """Set up the equations of the new vertices of a patch, see `quadpatch.filling.fairing.FairingEquations`.

    Parameters
    ----------
    patch : Refined
    adjacent_triangles : (k, 3) int64
        Triangles of the input next to the holes.
    connectivity : Connectivity, optional
        That of an earlier shape of this patch.
    uniform : bool
        See `quadpatch.filling.fairing.fair`.
    """
    if connectivity is None:
        connectivity = Connectivity(np.concatenate([adjacent_triangles, patch.triangles]), patch.is_new)
    unit = None if uniform else unit_area(patch)
    return FairingEquations(patch.vertices, connectivity, uniform=uniform, unit_area=unit)


def unit_area(patch: Refined) -> float | None:
    """Estimate the mean area at the new vertices that a graded patch would have were it uniform, in mesh units squared.

    The weights of an energy depend on it: so they mean the same with and without grading.
    """
    if patch.grading is None:
        return None
    areas = length(area_vectors(patch.vertices, patch.triangles)) / 2
    n_uniform = areas / (_AREA_OF_VERTEX * patch.grading.finest[patch.hole] ** 2)
    return float(areas.sum() / max(n_uniform.sum(), 1.0))


def fair_refined(patch: Refined, adjacent_triangles: Triangles, energy: Energy, *, uniform: bool = False) -> Refined:
    """Move the new vertices of a patch to where the surface has least energy."""
    return replace(patch, vertices=equations_of(patch, adjacent_triangles, uniform=uniform).minimise(energy))
