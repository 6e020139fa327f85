"""Histograms: counts in equal bins, and the bars that show them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from quadpatch.types import FloatArray

_BINS = 16

# Of the picture, in its own units.
WIDTH, HEIGHT = 640, 200
_LEFT, _RIGHT, _TOP, _BOTTOM = 8, 8, 22, 34


@dataclass(frozen=True)
class Bar:
    """One bin: its bounds, its count, and its place in the picture."""

    low: float
    high: float
    count: int
    x: float
    y: float
    width: float
    height: float


def histogram(values: FloatArray | Sequence[float]) -> dict[str, Any] | None:
    """Count values in equal bins, JSON-ready: `edges`, one more than `counts`. None without values."""
    numbers = np.asarray(values, dtype=np.float64)
    if not len(numbers) or not np.isfinite(numbers).all():
        return None
    counts, edges = np.histogram(numbers, bins=_BINS)
    return {"edges": edges.tolist(), "counts": counts.tolist()}


def bars(counted: Mapping[str, Any]) -> list[Bar]:
    """Lay out the bars of a histogram."""
    edges, counts = counted["edges"], counted["counts"]
    step = (WIDTH - _LEFT - _RIGHT) / len(counts)
    tallest = max(*counts, 1)
    laid_out = []
    for i, count in enumerate(counts):
        height = round((HEIGHT - _TOP - _BOTTOM) * count / tallest, 1)
        x, y = round(_LEFT + i * step + 1, 1), round(HEIGHT - _BOTTOM - height, 1)
        laid_out.append(Bar(edges[i], edges[i + 1], count, x, y, round(step - 2, 1), height))
    return laid_out
