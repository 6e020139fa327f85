"""Meshes with a gap between two rims, and what the surface there was."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.holes import Hole, find_holes
from quadpatch.types import FloatArray, TriangleMesh, Vertices
from tests.quadpatch.shapes import cylinder, open_grid, sphere, torus, without

# Distance of points (n, 3) to the surface: (n,).
Distance = Callable[[Vertices], FloatArray]


@dataclass(frozen=True)
class Gap:
    """A mesh with gaps: which loops face each other, how wide the gap is, and where the surface was."""

    mesh: TriangleMesh
    pairs: tuple[tuple[int, int], ...]
    width: float
    distance: Distance


def to_sphere(points: Vertices) -> FloatArray:
    return np.asarray(np.abs(np.linalg.norm(points, axis=1) - 1))


def to_torus(points: Vertices) -> FloatArray:
    return np.asarray(np.abs(np.hypot(np.hypot(points[:, 0], points[:, 1]) - 3, points[:, 2]) - 1))


def to_tube(points: Vertices) -> FloatArray:
    return np.asarray(np.abs(np.hypot(points[:, 0], points[:, 1]) - 1))


def wave(x: FloatArray, y: FloatArray) -> FloatArray:
    return np.asarray(0.3 * np.sin(2 * x) * np.cos(1.5 * y))


def to_wave(points: Vertices) -> FloatArray:
    return np.asarray(np.abs(points[:, 2] - wave(points[:, 0], points[:, 1])))


def halves(width: float, n_subdivisions: int = 4) -> Gap:
    """Cut a sphere in two halves of different size."""
    whole = sphere(n_subdivisions)
    mesh = without(whole, np.abs(whole.vertices[:, 2] - 0.1) < width / 2)
    return Gap(mesh, ((0, 1),), width, to_sphere)


def torn_sphere(width: float = 0.3, seed: int | None = None) -> Gap:
    """Tear a sphere along a winding line; with a seed, triangles along the rims are gone by chance."""
    whole = sphere(5)
    angle = np.arctan2(whole.vertices[:, 1], whole.vertices[:, 0])
    line = 0.1 * np.sin(5 * angle) + 0.05 * np.sin(17 * angle)
    mesh = without(whole, np.abs(whole.vertices[:, 2] - line) < width / 2)
    if seed is not None:
        at_rim = np.flatnonzero(np.isin(mesh.triangles, np.concatenate([h.loop for h in find_holes(mesh)])).any(axis=1))
        gone = np.random.default_rng(seed).choice(at_rim, len(at_rim) // 4, replace=False)
        mesh = TriangleMesh(mesh.vertices, np.delete(mesh.triangles, gone, axis=0))
    return Gap(mesh, ((0, 1),), width, to_sphere)


def cut_torus(width: float = 0.6, n_around: int = 160) -> Gap:
    """Cut a torus twice: two pieces, four loops."""
    whole = torus(n_around, n_around // 3)
    angle = np.arctan2(whole.vertices[:, 1], whole.vertices[:, 0])
    places = (0.0, 2.0)
    mesh = without(whole, np.any([np.abs(angle - place) < width / 6 for place in places], axis=0))
    holes = find_holes(mesh)
    at = np.array([np.arctan2(hole.centre[1], hole.centre[0]) for hole in holes])
    first, second = (np.flatnonzero(np.abs(at - place) < width / 2).tolist() for place in places)
    return Gap(mesh, ((first[0], first[1]), (second[0], second[1])), width, to_torus)


def cut_tube(width: float = 0.5, n_upper: int = 40) -> Gap:
    """Put two tubes on one axis: the lower one has 40 vertices around, the upper one as many as asked for."""
    lower, upper = cylinder(40, 20, length=2.0), cylinder(n_upper, n_upper // 2, length=2.0)
    top, above = lower.vertices[:, 2].max(), upper.vertices[:, 2].min()
    shifted = upper.vertices + np.array([0.0, 0.0, top + width - above])
    mesh = TriangleMesh(
        np.concatenate([lower.vertices, shifted]),
        np.concatenate([lower.triangles, upper.triangles + len(lower.vertices)]),
    )
    inner = [hole.id for hole in find_holes(mesh) if abs(hole.centre[2] - top) < width + 0.1]
    return Gap(mesh, ((inner[0], inner[1]),), width, to_tube)


def torn_sheet(width: float = 0.3, n: int = 41) -> Gap:
    """Tear a wavy sheet of side 2 in two along a winding line."""
    flat = open_grid(n, 2.0).vertices
    x, y = flat[:, 0], flat[:, 1]
    whole = TriangleMesh(np.stack([x, y, wave(x, y)], axis=1), open_grid(n, 2.0).triangles)
    mesh = without(whole, np.abs(x - 0.1 - 0.1 * np.sin(6 * y)) < width / 2)
    return Gap(mesh, ((0, 1),), width, to_wave)


def ends_of(gap: Gap) -> tuple[Hole, Hole]:
    """The two loops of the first pair."""
    holes = find_holes(gap.mesh)
    first, second = gap.pairs[0]
    return holes[first], holes[second]
