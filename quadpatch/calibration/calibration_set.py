"""Calibration: holes cut into undamaged surface of the very mesh that is to be repaired, where the truth is known.

They are as large as the real ones, or the largest for which the surface has room, and filled by the same code. From
them follow the energy that continues this surface best, the blend factor of a model, and how large an
error to expect.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import sqrt

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.calibration.error_model import ErrorModel, fit_error_model
from quadpatch.calibration.synthetic_holes import MeshWithHoles, Spacing, UncutSurface, cut_holes
from quadpatch.filling.fairing import Energy, triangles_around
from quadpatch.filling.fill import ClosedMesh, close_rims
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.rim_neighbourhood import RimNeighbourhood
from quadpatch.mesh.averages import mean_by, mean_of_corners
from quadpatch.mesh.distance import DistanceTree, distance_to_mesh
from quadpatch.mesh.loop_diameter import loop_diameter
from quadpatch.mesh.normals import area_vectors, length, vertex_areas
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Vertices

# Calibration holes. On scans, 16 to 64 of them lead to the same errors of repairs within half a percent.
MAX_HOLES = 24
# Where these leave it open whether a model gains, so many are cut, the first ones among them.
MORE_HOLES = 3 * MAX_HOLES
_ENOUGH = 16
# Fewer holes than this decide nothing.
MIN_HOLES = 12
# Narrower calibration holes than this, in mean edge lengths, say nothing of wider ones: a cut takes hardly a ring.
_NARROWEST = 5.0
# Surface left between a calibration hole and any other rim, in mean edge lengths: what the fairing reads, and a ring.
MARGIN_EDGES = 4.0
# Diameters in diameters of the real holes, and margins, that are tried until enough holes find room. Narrower holes
# say less of the real ones than holes without the spare ring.
_TRIES = ((1.0, MARGIN_EDGES), (1.0, 3.0), (0.7, MARGIN_EDGES), (0.5, MARGIN_EDGES))

# Points of a hole that are looked at, at least where there are as many: more of them tell the same within a percent.
_POINTS_PER_HOLE = 1000

# Errors that differ by less than this share of a hole's diameter are the same.
ROUNDING = 1e-9

# Shares of the predicted displacement that are tried, and what a share must gain over none to be taken.
SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)
_LEAST_GAIN = 0.02
# The same in standard errors of the gain: chance alone comes so far at one mesh in twenty, and to one of them at one in
# six.
_LEAST_GAIN_IN_ERRORS = 1.64
# Gains of fewer standard errors than the first would hardly come to those above with `MORE_HOLES`; gains of more than
# the second are believed at once: the boundaries of O'Brien and Fleming for a first look at a third of the data.
_LOOKS = sqrt(MORE_HOLES / MAX_HOLES)
_OPEN_IN_ERRORS = (_LEAST_GAIN_IN_ERRORS / _LOOKS, _LEAST_GAIN_IN_ERRORS * _LOOKS)
# What holes may lose together, as a share of what others gain, for a gain to be no chance.
_MOST_LOST = 0.05


@dataclass(frozen=True)
class CalibrationSet:
    """A mesh with calibration holes. Real holes are open in it.

    Attributes
    ----------
    truth : TriangleMesh
        The surface that was cut away, with a ring around it.
    removed : (n_vertices,) bool
        Vertices of the mesh that were cut away.
    cut_away : (n_triangles,) bool
        Triangles of the mesh that calibration holes took.
    loops : list of (n_loop,) int64
        Rims of the calibration holes.
    opened : TriangleMesh
        The mesh without what they took.
    diameter : float
        That the calibration holes were meant to have, in mesh units.
    diameters : (n_holes,) float64
        That their rims have.
    """

    truth: TriangleMesh
    removed: BoolArray
    cut_away: BoolArray
    loops: list[IntArray]
    opened: TriangleMesh
    diameter: float
    diameters: FloatArray

    @cached_property
    def closed(self) -> ClosedMesh:
        """The calibration holes, closed again: by few vertices where they are large for their edges."""
        return close_rims(self._near, self._near.grading)

    def closed_uniformly(self) -> ClosedMesh:
        """Close them as densely as real holes."""
        return close_rims(self._near)

    @cached_property
    def _near(self) -> RimNeighbourhood:
        return RimNeighbourhood.of(self.opened, self.loops).straightened()

    @property
    def is_graded(self) -> bool:
        """Whether the holes are closed with fewer vertices than real ones of their size."""
        return self.closed.plate.grading is not None

    @property
    def removed_vertices(self) -> Vertices:
        """Where the vertices lay that were cut away: (r, 3)."""
        return self.truth.vertices[self.removed]

    @cached_property
    def truth_tree(self) -> DistanceTree:
        """For distances to the truth."""
        return DistanceTree(self.truth)


def cut_calibration_set(
    mesh: TriangleMesh, diameter: float, edge_length: float, rng: np.random.Generator, most: int = MAX_HOLES
) -> CalibrationSet | None:
    """Cut holes into undamaged surface.

    Parameters
    ----------
    mesh : TriangleMesh
    diameter : float
        Of the real holes, in mesh units.
    edge_length : float
        Mean edge length, in mesh units.
    rng : numpy.random.Generator
        Picks the places.
    most : int
        At most so many holes. With more of them, the same generator picks the same places first.

    Returns
    -------
    CalibrationSet or None
        None where the undamaged surface has no room for enough holes.
    """
    best: tuple[MeshWithHoles, float] | None = None
    surface = UncutSurface(mesh)
    for size, margin in _TRIES:
        if size < 1.0 and size * diameter < _NARROWEST * edge_length:
            break
        spacing = Spacing(edge_length, margin * edge_length, most)
        punched = cut_holes(surface, size * diameter, spacing, rng)
        # A few holes without the spare ring are no better than none.
        least = MIN_HOLES if margin == MARGIN_EDGES else _ENOUGH
        if len(punched.loops) >= least and (best is None or len(punched.loops) > len(best[0].loops)):
            best = punched, size * diameter
        if len(punched.loops) >= _ENOUGH:
            break
    if best is None:
        return None
    punched, used = best
    adjacent = triangles_around(mesh.triangles, np.flatnonzero(punched.removed), len(mesh.vertices), 2)
    truth = TriangleMesh(mesh.vertices, mesh.triangles[adjacent])
    diameters = np.array([loop_diameter(mesh.vertices[loop]) for loop in punched.loops])
    return CalibrationSet(truth, punched.removed, punched.cut_away, punched.loops, punched.mesh, used, diameters)


def choose_energy(errors: FloatArray, diameter: float, energies: Sequence[Energy], default: Energy) -> Energy:
    """Choose the energy that leaves the calibration holes, of some diameter, closest to the truth.

    Takes errors (n_energies, n_holes) as `error_per_hole` measures them, in mesh units as the diameter.

    The default one stays unless the best is better by more than a standard error: a few dozen holes can't tell more
    (L. Breiman et al., "Classification and Regression Trees", 1984, the rule of one standard error).
    """
    best = int(errors.mean(axis=1).argmin())
    lost = errors[energies.index(default)] - errors[best]
    is_tie = float(lost.mean()) <= float(lost.std()) / np.sqrt(len(lost)) + ROUNDING * diameter
    return default if is_tie else energies[best]


def choose_blend_factor(calibration: CalibrationSet, filled: FilledMesh, displacement: FloatArray) -> float:
    """Choose the share of predicted displacements (k, 3) that leaves the smallest mean error.

    It is 0 where that gains less than two percent, or may be chance (`_is_no_chance`).
    """
    return SHARES[choose_share(error_by_share(calibration, filled, displacement))]


def choose_share(errors: FloatArray) -> int:
    """Choose one of `SHARES` by the errors (n_shares, n_holes) that it leaves, as `choose_blend_factor` does."""
    best = int(errors.mean(axis=1).argmin())
    gains = errors[0] - errors[best]
    return best if _is_worth_it(errors[0], gains) and _is_no_chance(gains) else 0


def is_open(errors: FloatArray) -> bool:
    """Whether more holes may well tell if a share gains, by the errors (n_shares, n_holes) that `SHARES` leave.

    The gain of the best one is worth it, and is neither hopeless nor sure.

    References
    ----------
    P. O'Brien, T. Fleming, "A multiple testing procedure for clinical trials", Biometrics 35, 1979.
    """
    gains = errors[0] - errors[int(errors.mean(axis=1).argmin())]
    low, high = _OPEN_IN_ERRORS
    return _is_worth_it(errors[0], gains) and low < _in_standard_errors(gains) < high and not _is_loss_small(gains)


def may_gain(calibration: CalibrationSet, filled: FilledMesh, displacement: FloatArray) -> bool:
    """Whether any share of displacements (k, 3) has a gain that is no chance, be it as little as it may."""
    errors = error_by_share(calibration, filled, displacement)
    return any(_is_no_chance(errors[0] - of_share) for of_share in errors[1:])


def _is_worth_it(errors: FloatArray, gains: FloatArray) -> bool:
    return float(gains.mean()) > _LEAST_GAIN * float(errors.mean())


def _is_no_chance(gains: FloatArray) -> bool:
    """Whether gains (n_holes,) have a mean of over 1.64 standard errors: a few dozen holes can't tell more.

    Where hardly any hole loses, the rare ones that gain much are enough.
    """
    return _in_standard_errors(gains) > _LEAST_GAIN_IN_ERRORS or _is_loss_small(gains)


def _in_standard_errors(gains: FloatArray) -> float:
    """Give the mean of gains (n_holes,) in its standard errors; 0 where all are the same."""
    error = float(gains.std()) / np.sqrt(len(gains))
    return float(gains.mean()) / error if error > 0 else 0.0


def _is_loss_small(gains: FloatArray) -> bool:
    return float(-gains[gains < 0].sum()) < _MOST_LOST * float(gains[gains > 0].sum())


def error_by_share(calibration: CalibrationSet, filled: FilledMesh, displacement: FloatArray) -> FloatArray:
    """Measure errors (n_shares, n_holes) with each of `SHARES` of displacements (k, 3), in mesh units."""
    new = filled.mesh.vertices[filled.n_measured_vertices :]
    return np.array([error_per_hole(calibration, filled.with_vertices(new + share * displacement)) for share in SHARES])


def error_per_hole(calibration: CalibrationSet, filled: FilledMesh) -> FloatArray:
    """Measure how far each calibration hole's fill is from the true surface, both ways.

    Half from the new surface to the truth, half from the vertices that were cut away to the fill. The former is an
    integral over the new triangles, by the rule that is exact for quadratic functions: three quarters of the weight at
    the centroid, a twelfth at each corner. Without areas, the many small triangles at a rim, where every fill is right,
    would favour energies that err in the middle. A thousand or two of each are looked at.

    Returns
    -------
    (n_holes,) float64
        Mean distance, in mesh units.
    """
    n_holes, n = len(filled.disagreement), filled.n_measured_vertices
    vertices = filled.mesh.vertices
    new = filled.mesh.triangles[filled.n_measured_triangles :]
    centroids = mean_of_corners(vertices[new])
    # Corners at the rim lie on the truth.
    points, hole = np.concatenate([vertices[n:], centroids]), np.concatenate([filled.vertex_hole, filled.triangle_hole])
    areas = 0.5 * length(area_vectors(vertices, new))
    weights = np.concatenate([0.25 * vertex_areas(vertices, new)[n:], 0.75 * areas])
    kept = _enough_of_each(hole, n_holes)
    there = mean_by(hole[kept], calibration.truth_tree.distance(points[kept]), n_holes, weights[kept])
    # Every removed vertex belongs to the hole whose new surface is nearest.
    removed = calibration.removed_vertices
    nearest = filled.triangle_hole[cKDTree(centroids).query(removed)[1]]
    kept = _enough_of_each(nearest, n_holes)
    back = mean_by(nearest[kept], distance_to_mesh(removed[kept], TriangleMesh(vertices, new)), n_holes)
    return 0.5 * (there + back)


def _enough_of_each(hole: IntArray, n_holes: int) -> IntArray:
    """Choose points (k,) whose holes (n,) are known: of every hole with too many, each second or third and so on."""
    order = np.argsort(hole, kind="stable")
    count = np.bincount(hole, minlength=n_holes)
    rank = np.arange(len(hole)) - np.repeat(np.cumsum(count) - count, count)
    step = np.maximum(count // _POINTS_PER_HOLE, 1)
    return np.asarray(order[rank % step[hole[order]] == 0])


def distance_per_hole(calibration: CalibrationSet, filled: FilledMesh) -> FloatArray:
    """Mean distance (n_holes,) of each calibration hole's new vertices to the true surface; 0 without any.

    Vertices weigh as much as the area at them: where a fill is graded, they are dense at its rim.
    """
    n, new = filled.n_measured_vertices, filled.mesh.triangles[filled.n_measured_triangles :]
    areas = vertex_areas(filled.mesh.vertices, new)[n:]
    distance = calibration.truth_tree.distance(filled.mesh.vertices[n:])
    return mean_by(filled.vertex_hole, distance, len(filled.disagreement), areas)


def expect(calibration: CalibrationSet, filled: FilledMesh) -> ErrorModel:
    """Learn from the calibration holes, filled like the real ones, how large an error to expect."""
    return fit_error_model(filled, calibration.diameters, distance_per_hole(calibration, filled))
