"""Numbers that a file holds for each vertex, by the name that it gives them: PLY alone has such names."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadpatch.errors import OptionError
from quadpatch.formats.ply.reader import PlySource
from quadpatch.formats.scan import Scan
from quadpatch.types import BoolArray

# Names in one message; a file may declare thousands.
_MOST_NAMES = 30


def vertex_property(scan: Scan, name: str) -> NDArray[Any]:
    """Look up a vertex property of a PLY file.

    Parameters
    ----------
    scan : Scan
    name : str

    Returns
    -------
    (n,)
        In the file's own type.

    Raises
    ------
    OptionError
        If the file has no such property, or lists instead of numbers; its message names the properties that it has.
    """
    if not isinstance(scan.source, PlySource):
        raise OptionError(f"vertex properties have names in PLY files only; this one is {scan.format}")
    rows = scan.source.file.element("vertex")
    column = None if rows is None else rows.scalar(name)
    if rows is None or column is None:
        names = [prop.name[:40] for prop in rows.element.properties if prop.count_code is None] if rows else []
        more = ", ..." if len(names) > _MOST_NAMES else ""
        raise OptionError(
            f"the file has no vertex property {name[:40]!r}; it has {', '.join(names[:_MOST_NAMES])}{more}"
        )
    return column


def vertex_mask(scan: Scan, name: str) -> BoolArray:
    """Take a vertex property as a mask: (n,) bool, True where its number is not 0; NaN counts as 0.

    Raises
    ------
    OptionError
        As `vertex_property`.
    """
    values = vertex_property(scan, name)
    return np.asarray((values != 0) & (values == values))  # noqa: PLR0124  NaN differs from itself
