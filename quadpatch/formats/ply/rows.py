"""The rows of one PLY element, however the file stores them.

A row is found by where it ends, counted in bytes of the file for binary bodies and in words of the body for ascii
ones. Rows of one length everywhere, which is what nearly all files hold, are read as one structured array.

Tested in `tests/quadpatch/formats/ply/test_writer.py`.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadpatch.errors import ReadError
from quadpatch.formats.ply.header import Element
from quadpatch.mesh.passes import parts_of
from quadpatch.types import IntArray

Values = NDArray[Any]

# Rows that are cast together.
_CHUNK = 1 << 15


@dataclass(frozen=True)
class ListColumn:
    """Lists of one property.

    Attributes
    ----------
    counts : (n,) int64
    stored : (n, k) or (sum of counts,) array
        Values as the file holds them: a table where all lists are equally long, else one list behind the other.
    """

    counts: IntArray
    stored: Values

    @cached_property
    def values(self) -> Values:
        """Values of all rows, one behind the other."""
        return self.stored.reshape(-1)

    def whole_numbers(self) -> IntArray:
        """Return the values as int64."""
        numbers = np.zeros(self.stored.shape, np.int64)
        for part in parts_of(len(numbers), _CHUNK):
            numbers[part] = self.stored[part]
        return numbers.reshape(-1)

    @property
    def starts(self) -> IntArray:
        """Where each row's values begin, (n,) int64."""
        return np.cumsum(self.counts) - self.counts


@dataclass(frozen=True)
class Rows:
    """All rows of one element.

    Attributes
    ----------
    element : Element
    start, stop : int
        Range in bytes of the file, or in words of an ascii body.
    ends : (n,) int64 or None
        Where each row ends, None where all rows are equally long.
    columns : tuple
        One array (n,) or one ListColumn for each property, in the file's own type.
    """

    element: Element
    start: int
    stop: int
    ends: IntArray | None
    columns: tuple[Values | ListColumn, ...]

    def row_ends(self) -> IntArray:
        """Where each row ends, (n,) int64."""
        if self.ends is not None:
            return self.ends
        stride = (self.stop - self.start) // max(self.element.count, 1)
        return self.start + stride * np.arange(1, self.element.count + 1, dtype=np.int64)

    def places(self, index: int, *, in_words: bool) -> IntArray:
        """First byte of a property's value in each row, or its word in an ascii body, (n,) int64.

        The count of a list stands in front of its values, and is where the list begins.
        """
        ends = self.row_ends()
        at = np.append(self.start, ends[:-1]) if len(ends) else ends
        for prop, column in zip(self.element.properties[:index], self.columns, strict=False):
            size = 1 if in_words else int(prop.code[1])
            if isinstance(column, ListColumn):
                at = at + (1 if in_words else int((prop.count_code or "u1")[1])) + column.counts * size
            else:
                at = at + size
        return np.asarray(at, dtype=np.int64)

    def scalar(self, name: str) -> Values | None:
        """Column of a property that is no list, None where there is none of that name."""
        index = self.element.find(name)
        column = None if index is None else self.columns[index]
        return None if isinstance(column, ListColumn) else column

    def list_column(self, *names: str) -> ListColumn | None:
        """Column of a list property, None where there is none of these names."""
        index = self.element.find(*names)
        column = None if index is None else self.columns[index]
        return column if isinstance(column, ListColumn) else None


def check_room(element: Element, smallest_row: int, room: int, unit: str) -> None:
    """Raise ReadError where a declared count can't fit what is left of the file, before anything is allocated."""
    if element.count * smallest_row > room:
        raise ReadError(
            f"PLY element {element.name[:40]!r} declares {element.count:,} rows of at least {smallest_row} {unit}; "
            f"{room:,} {unit} are left in the file"
        )
