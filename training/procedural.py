"""Procedural training meshes: patterned reliefs on bent sheets, made from a seed.

A sheet is a square of triangles bent into a plane, a cylinder or a cap of a sphere; a pattern lifts its vertices along
their normals. Vertices are jittered so that the triangles are as irregular as a scanner's. The mean edge is about one
mesh unit long.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from quadpatch.types import FloatArray, TriangleMesh, Triangles
from training.patterns import PATTERNS

# Periods in edge lengths. A patch spans 16 to 32 edges, and the base surface carries what is longer than about 25.
PERIODS = (5.0, 26.0)
# Height of a pattern (from its middle) as part of its period: from a scratch to a deep relief that is a height map yet.
DEPTHS = (0.02, 0.16)
# How far a vertex strays from its place in the grid, in edges, and the scanner's noise along the normal.
JITTER = 0.22
NOISE = (0.0, 0.02)


@dataclass(frozen=True)
class Relief:
    """A procedural mesh and what it shows."""

    pattern: str
    mesh: TriangleMesh


def reliefs(n_each: int, seed: int, n_side: int = 120) -> Iterator[Relief]:
    """Make every pattern several times, each time otherwise.

    Parameters
    ----------
    n_each : int
        Meshes of each pattern.
    seed : int
        Same seed, same bits.
    n_side : int
        Vertices along one side of a sheet.

    Yields
    ------
    Relief
    """
    for number, name in enumerate(sorted(PATTERNS)):
        for variant in range(n_each):
            rng = np.random.default_rng([seed, number, variant])
            yield Relief(name, relief_mesh(name, rng, n_side))


def relief_mesh(pattern: str, rng: np.random.Generator, n_side: int) -> TriangleMesh:
    """Make one patterned sheet of ``n_side ** 2`` vertices."""
    flat = _jittered_grid(n_side, rng)
    period = float(np.exp(rng.uniform(*np.log(PERIODS))))
    depth = rng.uniform(*DEPTHS) * period
    heights = depth * PATTERNS[pattern](_turned(flat, rng) / period, rng)
    heights = heights + rng.uniform(*NOISE) * rng.normal(size=len(flat))
    points, normals = _bend(flat, float(n_side), rng)
    return TriangleMesh(points + heights[:, None] * normals, sheet_triangles(n_side))


def _jittered_grid(n_side: int, rng: np.random.Generator) -> FloatArray:
    """Points (n_side ** 2, 2) about the origin, one edge apart."""
    ticks = np.arange(n_side) - 0.5 * (n_side - 1)
    x, y = np.meshgrid(ticks, ticks)
    # Edges of a grid cut into triangles: two sides to one diagonal. Shrunk so that their mean is 1.
    mean_edge = (2.0 + np.sqrt(2.0)) / 3.0
    grid = np.stack([x.ravel(), y.ravel()], axis=1)
    return np.asarray((grid + rng.uniform(-JITTER, JITTER, grid.shape)) / mean_edge)


def _turned(points: FloatArray, rng: np.random.Generator) -> FloatArray:
    angle = rng.uniform(0.0, 2.0 * np.pi)
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return np.asarray(points @ rotation.T + rng.uniform(0.0, 100.0, 2))


def _bend(flat: FloatArray, size: float, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Bend the square into a plane, a cylinder or a cap; points and unit normals (n, 3)."""
    x, y = flat[:, 0], flat[:, 1]
    shape = rng.choice(["plane", "cylinder", "sphere"])
    radius = rng.uniform(0.35, 1.0) * size
    zero = np.zeros_like(x)
    if shape == "plane":
        return np.stack([x, y, zero], axis=1), np.stack([zero, zero, zero + 1.0], axis=1)
    if shape == "cylinder":
        # The sheet keeps its measures: x becomes the arc.
        normals = np.stack([np.sin(x / radius), zero, np.cos(x / radius)], axis=1)
        return radius * normals + np.stack([zero, y, zero], axis=1), normals
    # The azimuthal equidistant map: distances from the middle become arcs.
    distance = np.hypot(x, y)
    angle = distance / (radius * 1.3)
    along = np.divide(np.sin(angle), distance, out=np.zeros_like(distance), where=distance > 0.0)
    normals = np.stack([along * x, along * y, np.cos(angle)], axis=1)
    return radius * 1.3 * normals, normals


def sheet_triangles(n_side: int) -> Triangles:
    """Cut every square in two, the diagonal turning from square to square."""
    row, column = np.divmod(np.arange((n_side - 1) ** 2), n_side - 1)
    a = row * n_side + column
    b, c, d = a + 1, a + n_side + 1, a + n_side
    even = ((row + column) % 2 == 0)[:, None]
    first = np.where(even, np.stack([a, b, c], axis=1), np.stack([a, b, d], axis=1))
    second = np.where(even, np.stack([a, c, d], axis=1), np.stack([b, c, d], axis=1))
    return np.concatenate([first, second]).astype(np.int64)
