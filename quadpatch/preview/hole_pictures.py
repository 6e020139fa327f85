"""Numbered close-ups: one picture for each hole, before and after, seen along the mean normal of its rim.

One for each bridge as well, seen from where most of its strip shows.
"""

from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from quadpatch.preview.camera import UP, Camera, View, view_of
from quadpatch.preview.pair import Pair
from quadpatch.preview.png import png_bytes, to_pixels
from quadpatch.preview.sampling import Colours
from quadpatch.types import FloatArray, Vertices

# In pixels.
_TILE = 420
_GAP = 8
_CAPTION_HEIGHT = 30
_INSET = 12
_NUMBER_SIZE = 34
_RIM_WIDTH = 2

# A tile is this many times as wide as its hole.
_SURROUNDINGS = 2.4
_INK = (42, 46, 54)
_PAPER = (255, 255, 255)
_RIM = (32, 96, 190)


@dataclass(frozen=True)
class NumberedHole:
    """A hole to be drawn.

    Attributes
    ----------
    id : int
        As in the report.
    rim : (n, 3) float64
        Its loop, with the surface on the left.
    far_end : NumberedHole or None
        The loop that a bridge joins it to.
    towards : (3,) float64 or None
        Unit vector to the viewer; None looks along the mean normal.
    """

    id: int
    rim: Vertices
    far_end: "NumberedHole | None" = None
    towards: FloatArray | None = None

    @property
    def loops(self) -> list["NumberedHole"]:
        """It, and the loop that it is joined to."""
        return [self] if self.far_end is None else [self, self.far_end]

    @property
    def title(self) -> str:
        """What the picture shows."""
        return f"hole {self.id}" if self.far_end is None else f"bridge {self.id}:{self.far_end.id}"

    @property
    def number(self) -> str:
        """Its number, or both numbers of a bridge."""
        return ":".join(str(loop.id) for loop in self.loops)


def draw_hole(pair: Pair, hole: NumberedHole) -> bytes:
    """Draw a hole before and after the repair, with its rim and its number, and return the bytes of a PNG file."""
    camera = _camera(pair, hole)
    sheet = Image.new("RGB", (2 * _TILE + _GAP, _CAPTION_HEIGHT + _TILE), _PAPER)
    pen = ImageDraw.Draw(sheet)
    before, after = pair.draw(camera, (_TILE, _TILE))
    for left, picture, caption in ((0, before, "before"), (_TILE + _GAP, after, "after")):
        pen.text((left + _INSET, 4), f"{hole.title}, {caption}", font=ImageFont.load_default(17), fill=_INK)
        sheet.paste(_tile(picture, camera, hole), (left, _CAPTION_HEIGHT))
    return png_bytes(sheet)


def mean_normal(rim: Vertices) -> FloatArray:
    """Give the unit normal (3,) of the surface around a hole; zero for a rim that spans no area.

    It is the direction against the vector area of the loop, which has the surface on its left and so runs clockwise
    seen from outside.
    """
    centred = rim - rim.mean(axis=0)
    size = np.abs(centred).max() or 1.0
    centred = centred / size
    vector = -np.cross(centred, np.roll(centred, -1, axis=0)).sum(axis=0)
    length = float(np.linalg.norm(vector))
    return np.asarray(vector / length if length > 0 else np.zeros(3))


def _camera(pair: Pair, hole: NumberedHole) -> Camera:
    rim = np.concatenate([loop.rim for loop in hole.loops])
    normal = mean_normal(rim)
    if not normal.any():
        normal = UP
    along = -normal if pair.is_flipped else normal
    towards = along if hole.towards is None else hole.towards
    tight = view_of(rim, towards, 1.0)
    clearance = _SURROUNDINGS * float(np.linalg.norm(np.ptp(rim, axis=0)))
    return Camera(tight.centre, tight.right, tight.up, towards, tight.width * _SURROUNDINGS, clearance)


def _tile(picture: Colours, camera: Camera, hole: NumberedHole) -> Image.Image:
    """Put the rim and the number into a picture."""
    tile = Image.fromarray(to_pixels(picture))
    pen = ImageDraw.Draw(tile)
    for loop in hole.loops:
        columns, rows = View(camera, (_TILE, _TILE)).places(loop.rim)
        around = np.append(np.arange(len(columns)), 0)
        pen.line(list(zip(columns[around].tolist(), rows[around].tolist(), strict=True)), fill=_RIM, width=_RIM_WIDTH)
    font = ImageFont.load_default(_NUMBER_SIZE)
    at = (_INSET, _INSET)
    left, top, right, bottom = pen.textbbox(at, hole.number, font=font)
    pen.rectangle((left - 6, top - 6, right + 6, bottom + 6), fill=_PAPER, outline=_RIM)
    pen.text(at, hole.number, font=font, fill=_RIM)
    return tile
