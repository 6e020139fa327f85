"""Packing of rectangles into a page whose sides are powers of two, on shelves: next fit, by decreasing height.

References
----------
A. Lodi, S. Martello, M. Monaci, "Two-dimensional packing problems: a survey", European Journal of Operational Research
141, 2002.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.types import IntArray


@dataclass(frozen=True)
class Packing:
    """Where rectangles lie in a page, in texels.

    Attributes
    ----------
    width, height : int
        Of the page; powers of two.
    corners : (n, 2) int64
        Column and row of the first texel of each rectangle.
    """

    width: int
    height: int
    corners: IntArray

    @property
    def area(self) -> int:
        """Texels of the page."""
        return self.width * self.height


def pack(sizes: IntArray, largest: int) -> Packing | None:
    """Pack rectangles of widths and heights (n, 2) into the smallest page that takes them on shelves.

    None where a page with sides of at most `largest`, a power of two, does not.
    """
    order = np.lexsort([-sizes[:, 0], -sizes[:, 1]])
    found = [packed for exponent in range(largest.bit_length()) if (packed := _on_shelves(sizes, order, 2**exponent))]
    fitting = [packing for packing in found if packing.height <= largest]
    return min(fitting, key=lambda packing: (packing.area, max(packing.width, packing.height)), default=None)


def _on_shelves(sizes: IntArray, order: IntArray, width: int) -> Packing | None:
    """Put rectangles side by side, and on the next shelf where the row is full; None where one is too wide."""
    if sizes[:, 0].max() > width:
        return None
    corners = np.zeros_like(sizes)
    x = y = shelf = 0
    for number in order.tolist():
        wide, high = sizes[number].tolist()
        if x + wide > width:
            x, y, shelf = 0, y + shelf, 0
        corners[number] = x, y
        x, shelf = x + wide, max(shelf, high)
    return Packing(width, 1 << (y + shelf - 1).bit_length(), corners)
