"""Relief patterns: heights over the plane, computed from numbers alone.

Every pattern takes points (n, 2) in units of its own period (one wave, scale, brick or strand is about 1 wide) and a
random generator that varies it, and gives heights (n,) between about -1 and 1. Edges are rounded by a random amount,
as on cast, carved or worn things.
"""

from collections.abc import Callable

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.types import FloatArray

Pattern = Callable[[FloatArray, np.random.Generator], FloatArray]

TURN = 2.0 * np.pi


def waves(points: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Build one to three wave trains that cross, their crests round or sharp."""
    n_trains = int(rng.integers(1, 4))
    angles = rng.uniform(0.0, TURN, n_trains)
    frequencies = rng.uniform(0.7, 1.4, n_trains)
    directions = frequencies[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    trains = np.sin(TURN * points @ directions.T + rng.uniform(0.0, TURN, n_trains))
    return _sharpen(trains.mean(axis=1), rng)


def gyroid(points: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Cut through a gyroid: winding ridges and valleys."""
    x, y = TURN * points[:, 0], TURN * points[:, 1]
    z = rng.uniform(0.0, TURN) + rng.uniform(-0.3, 0.3) * x
    return _sharpen(np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x), rng)


def scales(points: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Overlap rows of tilted round scales, as on a fish or a roof."""
    tilt, radius = rng.uniform(0.5, 1.2), rng.uniform(0.62, 0.8)
    row = np.floor(points[:, 1] / 0.5)
    best = np.full(len(points), -1.0)
    for shift in (-1, 0, 1, 2):
        nearby = row + shift
        offset = 0.5 * (nearby % 2)
        dx = points[:, 0] - offset - np.round(points[:, 0] - offset)
        dy = points[:, 1] - 0.5 * nearby
        inside = dx**2 + dy**2 < radius**2
        dome = np.sqrt(np.maximum(radius**2 - dx**2 - dy**2, 0.0))
        best = np.where(inside, np.maximum(best, 0.5 * dome - tilt * dy), best)
    return 3.0 * (best - 0.5)


def knurl(points: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Cross two sets of V grooves, as on a tool handle."""
    half_angle = rng.uniform(0.35, 0.8)
    along, across = np.cos(half_angle) * points[:, 0], np.sin(half_angle) * points[:, 1]
    ridges = [np.abs(2.0 * ((t + rng.uniform()) % 1.0) - 1.0) for t in (along + across, along - across)]
    return _sharpen(2.0 * np.minimum(ridges[0], ridges[1]) - 1.0, rng)


def weave(points: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Weave round strands over and under each other."""
    width = rng.uniform(0.35, 0.5)
    best = np.full(len(points), -1.0)
    for along, across, sign in ((0, 1, 1.0), (1, 0, -1.0)):
        strand = np.floor(points[:, across])
        distance = points[:, across] - strand - 0.5
        profile = np.sqrt(np.maximum(1.0 - (distance / width) ** 2, 0.0))
        lift = sign * np.cos(np.pi * (points[:, along] - 0.5 + strand))
        best = np.where(np.abs(distance) < width, np.maximum(best, 0.5 * lift + 0.8 * profile - 0.4), best)
    return np.asarray(best)


def noise(points: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Add up random waves of several octaves, as on rock or bark; stretched one way or ridged now and then."""
    n_waves, roughness = 64, rng.uniform(0.6, 1.6)
    octave = rng.uniform(-1.0, 2.5, n_waves)
    angles = rng.uniform(0.0, TURN, n_waves)
    vectors = 2.0 ** octave[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    vectors[:, 0] *= rng.choice([1.0, 1.0, 0.3])
    weights = 2.0 ** (-roughness * octave)
    total = np.sin(TURN * points @ vectors.T + rng.uniform(0.0, TURN, n_waves)) @ weights
    total /= np.sqrt(0.5 * (weights**2).sum())
    return np.asarray(1.0 - np.abs(total) if rng.random() < 0.3 else 0.5 * total)


def bricks(points: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Lay rows of bricks or tiles with grooves between them, each a little higher or lower."""
    aspect, stagger = rng.uniform(1.0, 3.0), rng.choice([0.0, 0.5, 0.5])
    row = np.floor(points[:, 1])
    along = points[:, 0] / aspect + stagger * (row % 2)
    column = np.floor(along)
    to_edge = np.minimum(
        aspect * (0.5 - np.abs(along - column - 0.5)),
        0.5 - np.abs(points[:, 1] - row - 0.5),
    )
    lift = rng.uniform(0.0, 0.5) * _hashed(column, row, rng)
    return _groove(to_edge, rng) * (1.0 + lift) - 0.5


def pebbles(points: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Fill the plane with irregular cells: pebbles, leather or cracked ground."""
    low, high = points.min(axis=0) - 2.0, points.max(axis=0) + 2.0
    nodes = np.stack(np.meshgrid(*(np.arange(a, b) for a, b in zip(low, high, strict=True))), axis=-1).reshape(-1, 2)
    centres = nodes + rng.uniform(-0.45, 0.45, nodes.shape)
    distances = np.asarray(cKDTree(centres).query(points, k=2)[0])
    to_edge = 0.5 * (distances[:, 1] - distances[:, 0])
    return np.asarray(_groove(to_edge, rng) - 0.6 * distances[:, 0])


def strokes(points: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Carve or emboss short strokes in rows, as of an unknown script."""
    width, depth = rng.uniform(0.08, 0.16), rng.choice([-1.0, 1.0])
    columns, rows = np.floor(points[:, 0] / 1.2), np.floor(points[:, 1] / 1.6)
    local = np.stack([points[:, 0] / 1.2 - columns, points[:, 1] / 1.6 - rows], axis=1) * (1.2, 1.6)
    nearest = np.full(len(points), np.inf)
    for _ in range(3):
        ends = [
            np.stack([0.15 + 0.9 * _hashed(columns, rows, rng), 0.2 + 1.2 * _hashed(columns, rows, rng)], axis=1)
            for _ in range(2)
        ]
        nearest = np.minimum(nearest, _distance_to_segments(local, ends[0], ends[1]))
    profile = 1.0 / (1.0 + np.exp((nearest - width) / (0.3 * width)))
    return np.asarray(depth * (profile - 0.3))


def dimples(points: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Set round dents or studs in a triangular grid."""
    radius, depth = rng.uniform(0.25, 0.48), rng.choice([-1.0, 1.0])
    row_height = np.sqrt(0.75)
    nearest = np.full(len(points), np.inf)
    row = np.floor(points[:, 1] / row_height)
    for shift in (0, 1):
        offset = 0.5 * ((row + shift) % 2)
        dx = points[:, 0] - offset - np.round(points[:, 0] - offset)
        nearest = np.minimum(nearest, np.hypot(dx, points[:, 1] - row_height * (row + shift)))
    cap = np.sqrt(np.maximum(1.0 - (nearest / radius) ** 2, 0.0))
    return np.asarray(depth * (cap ** rng.uniform(0.5, 1.5) - 0.3))


PATTERNS: dict[str, Pattern] = {
    pattern.__name__: pattern
    for pattern in (waves, gyroid, scales, knurl, weave, noise, bricks, pebbles, strokes, dimples)
}


def _sharpen(heights: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Push heights towards two levels by a random amount; the slope between them gets steep."""
    steepness = rng.uniform(0.3, 3.0)
    return np.asarray(np.tanh(steepness * heights) / np.tanh(steepness))


def _groove(to_edge: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Rise from 0 at an edge to 1 inside, over a random width."""
    width = rng.uniform(0.05, 0.3)
    return np.asarray(1.0 - np.exp(-((to_edge / width) ** 2)))


def _hashed(column: FloatArray, row: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Draw a number from 0 to 1 for every cell of a grid, the same one each time the cell is met."""
    table = rng.random((64, 64))
    return np.asarray(table[column.astype(np.int64) % 64, row.astype(np.int64) % 64])


def _distance_to_segments(points: FloatArray, starts: FloatArray, ends: FloatArray) -> FloatArray:
    along = ends - starts
    squared = np.maximum((along**2).sum(axis=1), 1e-12)
    t = np.clip(((points - starts) * along).sum(axis=1) / squared, 0.0, 1.0)
    return np.asarray(np.linalg.norm(points - starts - t[:, None] * along, axis=1))
