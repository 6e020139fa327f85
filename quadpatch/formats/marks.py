"""Numbers of holes that an earlier repair wrote into a file: the next repair goes on counting behind them."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

# Higher numbers are no count of holes; they would also leave no room for further ones in an int.
_HIGHEST = 1_000_000_000

# Formats whose files hold the number of each hole.
NUMBERED = (".ply", ".glb", ".gltf", ".3mf")


def next_hole_id(marks: Iterable[NDArray[Any]]) -> int:
    """Return the number behind the highest mark: 0 where there are none.

    Parameters
    ----------
    marks : iterable of (k,) arrays
        Numbers of holes of any type; what is negative, not finite or beyond a count of holes is passed over.
    """
    highest = -1
    for values in marks:
        numbers = np.asarray(values, np.float64)
        numbers = numbers[(numbers >= 0) & (numbers <= _HIGHEST)]
        highest = max(highest, int(numbers.max(initial=-1)))
    return highest + 1
