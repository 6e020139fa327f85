"""The sheet: the mesh before and after, close-ups of its largest holes, captions and a legend."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from quadpatch.formats.output_files import write_whole
from quadpatch.mesh.raycast import RayScene
from quadpatch.preview.camera import Camera
from quadpatch.preview.invented import TINT, Invented, confidence_colours, spanned_rims
from quadpatch.preview.pair import Pair, filled_pair
from quadpatch.preview.parts import filled_holes, main_pieces, part_of
from quadpatch.preview.png import png_bytes, to_pixels
from quadpatch.preview.sampling import Colours
from quadpatch.preview.shading import BACK, CLAY
from quadpatch.preview.thinning import MOST_TRIANGLES, thinned
from quadpatch.preview.viewpoints import close_ups, overview
from quadpatch.types import BoolArray, FloatArray, TriangleMesh

# In pixels. Three pairs of tiles are as wide as the two panels.
_MARGIN = 28
_GAP = 16
_PANEL = (760, 600)
_TILE = (246, 246)
_PAIR_GAP = 4
_GROUP_GAP = 24
_WIDTH = 2 * _MARGIN + 2 * _PANEL[0] + _GAP
_CAPTION_HEIGHT = 28
_LEGEND_HEIGHT = 30
SWATCH = (120, 16)

N_CLOSE_UPS = 3
# Holes looked at to find three that can be seen.
N_CANDIDATES = 8
_INK = (42, 46, 54)
_GREY = (110, 116, 126)
_PAPER = (255, 255, 255)


@dataclass
class Sheet:
    """A white sheet that grows downwards: `top` is where the next row begins."""

    image: Image.Image
    pen: ImageDraw.ImageDraw
    top: int

    def write(self, text: str, left: int, size: int, colour: tuple[int, int, int]) -> None:
        """Write a line of text at the top of the row."""
        self.pen.text((left, self.top), text, font=ImageFont.load_default(size), fill=colour)

    def paste(self, picture: FloatArray | Colours, left: int) -> None:
        """Paste a picture (rows, columns, 3) of 0..1 at the top of the row."""
        self.image.paste(Image.fromarray(to_pixels(picture)), (left, self.top))


def render_before_after(mesh: TriangleMesh, invented: Invented, path: Path) -> None:
    """Write the picture of `before_after_png` as a file that appears whole or not at all."""
    write_whole(path, before_after_png(mesh, invented))


def before_after_png(mesh: TriangleMesh, invented: Invented) -> bytes:
    """Draw a mesh before and after its repair, and its largest holes in close-up.

    Parameters
    ----------
    mesh : TriangleMesh
        Repaired; triangles that touch share their vertices.
    invented : Invented
        What was not measured: the mesh before is without it, afterwards it is tinted.

    Returns
    -------
    bytes
        Of a PNG file.

    Raises
    ------
    EmptyMeshError
        If the mesh has no triangle of any area.
    """
    if len(mesh.triangles) > MOST_TRIANGLES:
        largest = [part_of(mesh, hole).corners for hole in filled_holes(mesh, invented.mask, N_CANDIDATES)]
        mesh, kept = thinned(mesh, largest)
        invented = invented.of(kept)
    pair = filled_pair(mesh, invented)
    holes = filled_holes(pair.after, invented.mask, N_CANDIDATES)
    camera = _camera_of_rims(pair, invented)
    shown = close_ups(pair.scene, [part_of(pair.after, hole) for hole in holes], camera, N_CLOSE_UPS)
    sheet = blank_sheet(has_close_ups=bool(shown))
    draw_overview(sheet, pair, camera)
    if shown:
        names = {i: f"hole {invented.hole[holes[i][0]]}" for i in shown} if invented.is_numbered else {}
        draw_close_ups(sheet, pair, shown, names)
    if invented.confidence is None:
        draw_legend(sheet, "invented surface", "measured surface", np.tile(TINT, (SWATCH[0], 1)))
    else:
        swatch = confidence_colours(np.linspace(0.0, 1.0, SWATCH[0]))
        draw_legend(sheet, "invented surface, confidence 0 to 1", "measured surface", swatch)
    return png_bytes(sheet.image)


def _camera_of_rims(pair: Pair, invented: Invented) -> Camera:
    """Look at the whole mesh from where most of its holes shows: the same place for all repairs of these holes."""
    measured = TriangleMesh(pair.after.vertices, pair.after.triangles[~invented.mask])
    if not invented.mask.any() or not len(measured.triangles):
        return overview_camera(pair, invented.mask)
    whole, rims = part_of(measured, main_pieces(measured)), spanned_rims(pair.after, invented.mask)
    return overview(RayScene(measured), whole, rims, _PANEL[0] / _PANEL[1])


def blank_sheet(*, has_close_ups: bool) -> Sheet:
    """Make a sheet with room for two panels, a legend, and close-ups if there are any."""
    height = 2 * _MARGIN + _CAPTION_HEIGHT + _PANEL[1] + _GAP + _LEGEND_HEIGHT
    height += _CAPTION_HEIGHT + _TILE[1] + _GAP if has_close_ups else 0
    image = Image.new("RGB", (_WIDTH, height), _PAPER)
    return Sheet(image, ImageDraw.Draw(image), _MARGIN)


def overview_camera(pair: Pair, invented: BoolArray) -> Camera:
    """Look at the whole mesh from where most of some of its triangles show."""
    filled = part_of(pair.after, np.flatnonzero(invented)) if invented.any() else None
    return overview(pair.scene, pair.whole, filled, _PANEL[0] / _PANEL[1])


def draw_overview(sheet: Sheet, pair: Pair, camera: Camera) -> None:
    """Draw the mesh before and after in two panels."""
    left, right = _MARGIN, _MARGIN + _PANEL[0] + _GAP
    sheet.write("before", left, 17, _INK)
    sheet.write("after", right, 17, _INK)
    sheet.top += _CAPTION_HEIGHT
    before, after = pair.draw(camera, _PANEL)
    sheet.paste(before, left)
    sheet.paste(after, right)
    sheet.top += _PANEL[1] + _GAP


def draw_close_ups(sheet: Sheet, pair: Pair, cameras: dict[int, Camera], names: dict[int, str]) -> None:
    """Draw a row of close-ups, each before and after, under its name or its number in the row."""
    group_width = 2 * _TILE[0] + _PAIR_GAP + _GROUP_GAP
    for k, i in enumerate(cameras):
        name = names.get(i, f"close-up {k + 1}")
        sheet.write(f"{name}: before, after", _MARGIN + k * group_width, 15, _GREY)
    sheet.top += _CAPTION_HEIGHT
    for k, camera in enumerate(cameras.values()):
        left = _MARGIN + k * group_width
        before, after = pair.draw(camera, _TILE)
        sheet.paste(before, left)
        sheet.paste(after, left + _TILE[0] + _PAIR_GAP)
    sheet.top += _TILE[1] + _GAP


def draw_legend(sheet: Sheet, changed: str, unchanged: str, swatch: FloatArray) -> None:
    """Draw a swatch for each kind of surface.

    Parameters
    ----------
    sheet : Sheet
    changed, unchanged : str
        What the tinted and the plain surface is.
    swatch : (n, 3) float64
        Colours of the tinted one.
    """
    left = _MARGIN
    plain = np.tile(CLAY, (40, 1))
    for colours, label in ((swatch, changed), (plain, unchanged), (np.tile(BACK, (40, 1)), "inside")):
        sheet.paste(np.tile(colours, (SWATCH[1], 1, 1)), left)
        left += len(colours) + 8
        sheet.write(label, left, 15, _GREY)
        left += round(ImageFont.load_default(15).getlength(label)) + 32
