"""Places on a lattice, each told by its difference from what earlier ones predict.

All of it is in whole numbers, so that encoder and decoder agree on every machine.
"""

import numpy as np

from quadpatch.errors import ReadError
from quadpatch.types import FloatArray, IntArray, Vertices

# Lattice coordinates are below this in size, so that sums of three can't overflow.
LARGEST = 1 << 38


def to_lattice(vertices: Vertices, origin: FloatArray, step: float) -> IntArray:
    """Round places (n, 3) to a lattice."""
    return np.rint((vertices - origin) / step).astype(np.int64)


def from_lattice(places: IntArray, origin: FloatArray, step: float) -> Vertices:
    """Return the places (n, 3) of lattice points, in mesh units."""
    return np.asarray(origin + places * step)


def residuals(places: IntArray, predictors: list[tuple[int, int, int]]) -> IntArray:
    """Differences (n, 3) of places from p + q - r of their predictors; the first stands for itself."""
    if not len(places):
        return places
    table = np.array(predictors, np.int64)
    predicted = places[table[:, 0]] + places[table[:, 1]] - places[table[:, 2]]
    predicted[0] = 0
    return places - predicted


def places_of(differences: IntArray, predictors: list[tuple[int, int, int]]) -> IntArray:
    """Undo `residuals`.

    Raises
    ------
    ReadError
        If a place lies beyond what a lattice may hold.
    """
    places: list[list[int]] = []
    for (p, q, r), difference in zip(predictors, differences.tolist(), strict=True):
        place = difference
        if p >= 0:
            place = [places[p][i] + places[q][i] - places[r][i] + difference[i] for i in range(3)]
        if max(map(abs, place)) >= LARGEST:
            raise ReadError("a vertex lies beyond the lattice")
        places.append(place)
    return np.array(places, np.int64).reshape(-1, 3)
