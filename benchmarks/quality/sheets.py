"""Sheets of pictures: rows of square tiles, each with a name, under one caption for the row.

Tested in `tests/benchmarks/quality/test_main.py`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from quadpatch.types import FloatArray

# In pixels.
TILE = 360
_GAP = 6
_LINE = 24


@dataclass(frozen=True)
class Row:
    """One row of a sheet.

    Attributes
    ----------
    caption : str
    tiles : mapping of str to (TILE, TILE, 3) float64
        Red, green, blue, 0..1, by name.
    """

    caption: str
    tiles: Mapping[str, FloatArray]


def compose(rows: Sequence[Row]) -> Image.Image:
    """Put rows below each other."""
    n_columns = max((len(row.tiles) for row in rows), default=1)
    sheet = Image.new("RGB", (n_columns * (TILE + _GAP) - _GAP, len(rows) * (2 * _LINE + TILE + _GAP)), "white")
    pen = ImageDraw.Draw(sheet)
    top = 0
    for row in rows:
        pen.text((4, top + 5), row.caption, font=ImageFont.load_default(14), fill="black")
        top += _LINE
        for k, (name, tile) in enumerate(row.tiles.items()):
            left = k * (TILE + _GAP)
            pen.text((left + 4, top + 4), name, font=ImageFont.load_default(13), fill=(90, 90, 90))
            sheet.paste(Image.fromarray(np.round(255 * tile).astype(np.uint8)), (left, top + _LINE))
        top += _LINE + TILE + _GAP
    return sheet
