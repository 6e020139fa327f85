"""Pictures of a repaired scan: a sheet before and after, and close-ups of its widest loops, filled or left open.

Tested in `tests/benchmarks/test_scans.py`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from quadpatch.formats.reading import read_scan
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.raycast import RayScene
from quadpatch.mesh.weld import weld
from quadpatch.preview.camera import Camera, view_of
from quadpatch.preview.invented import TINT, Invented
from quadpatch.preview.parts import Part, part_of
from quadpatch.preview.shading import CLAY, Clay
from quadpatch.preview.sheet import render_before_after
from quadpatch.preview.viewpoints import close_ups
from quadpatch.types import IntArray, TriangleMesh, Vertices

_TILE = 300
_GAP = 6
_CAPTION = 22
_PAIRS_PER_ROW = 3
_MOST_LOOPS = 24
# How much of the tint of invented surface is mixed into the clay: enough to see it, too little to hide its shape.
_STRENGTH = 0.4


@dataclass(frozen=True)
class _Scenes:
    """The mesh before and after, ready to be drawn."""

    before: Clay
    after: Clay
    scene: RayScene


def draw_scan(source: Path, repaired: Path, holes: Sequence[dict[str, Any]], folder: Path, name: str) -> None:
    """Draw `NAME.png`, the sheet, and `NAME_loops.png`, the widest loops.

    Parameters
    ----------
    source, repaired : Path
    holes : sequence of dict
        Of the report.
    folder : Path
        Made where it is missing.
    name : str
    """
    folder.mkdir(parents=True, exist_ok=True)
    before, after = _read(source), _read(repaired)
    is_new = np.arange(len(after.triangles)) >= len(before.triangles)
    render_before_after(after, Invented.of_mask(is_new), folder / f"{name}.png")
    scene = RayScene(after)
    tinted = np.where(is_new[:, None], CLAY + _STRENGTH * (TINT - CLAY), CLAY)
    grey = np.tile(CLAY, (len(before.triangles), 1))
    scenes = _Scenes(Clay(before, RayScene(before), grey), Clay(after, scene, tinted), scene)
    pairs = [
        (_caption(hole), _tiles(scenes, before.vertices[loop])) for hole, loop in _widest(before, holes, _MOST_LOOPS)
    ]
    if pairs:
        _compose(pairs).save(folder / f"{name}_loops.png", format="PNG", compress_level=6)


def _read(path: Path) -> TriangleMesh:
    """Read and weld; triangles keep the order of the file, also those that collapse."""
    scan = read_scan(path)
    welded = weld(scan.vertices, scan.triangles)
    return TriangleMesh(welded.mesh.vertices, welded.from_file[scan.triangles])


def _widest(mesh: TriangleMesh, holes: Sequence[dict[str, Any]], most: int) -> list[tuple[dict[str, Any], IntArray]]:
    """Find the loops of the widest holes: those with the same number of edges and the same perimeter."""
    loops = {_key(len(loop), _perimeter(mesh.vertices[loop])): loop for loop in boundary_loops(mesh.triangles).loops}
    widest = sorted(holes, key=lambda hole: -float(hole["diameter"]))
    pairs = [(hole, loops.get(_key(hole["edges"], hole["perimeter"]))) for hole in widest]
    return [(hole, loop) for hole, loop in pairs if loop is not None][:most]


def _key(n_edges: int, perimeter: float) -> tuple[int, str]:
    return n_edges, f"{perimeter:.8g}"


def _perimeter(points: Vertices) -> float:
    return float(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1).sum())


def _tiles(scenes: _Scenes, points: Vertices) -> list[Image.Image]:
    camera = _camera(scenes.scene, points)
    images = [clay.draw(camera, (_TILE, _TILE)) for clay in (scenes.before, scenes.after)]
    return [Image.fromarray(np.round(255 * tile).astype(np.uint8)) for tile in images]


def _camera(scene: RayScene, points: Vertices) -> Camera:
    """Look at a loop (n, 3) from where the surface that it spans shows."""
    n = len(points)
    ring = np.arange(n)
    # The surface lies on the left of a loop, so it runs clockwise around its hole.
    fan = np.stack([np.roll(ring, -1), ring, np.full(n, n)], axis=1)
    spanned: Part = part_of(TriangleMesh(np.vstack([points, points.mean(axis=0)]), fan), np.arange(n))
    mean = spanned.area_vectors.sum(axis=0)
    towards = mean / np.linalg.norm(mean) if mean.any() else np.array([0.0, 0.0, 1.0])
    return close_ups(scene, [spanned], view_of(points, towards, 1.0), 1)[0]


def _caption(hole: dict[str, Any]) -> str:
    text = f"{hole['id']}: {hole['edges']} edges, {hole['diameter']:.4g} wide, {hole['verdict']}"
    if hole["verdict"] in ("skipped", "refused"):
        return f"{text}, {hole['code']}"
    return f"{text}, confidence {hole['confidence']:.2f}"


def _compose(pairs: Sequence[tuple[str, list[Image.Image]]]) -> Image.Image:
    n_rows = -(-len(pairs) // _PAIRS_PER_ROW)
    width, height = 2 * _TILE + 3 * _GAP, _CAPTION + _TILE + _GAP
    sheet = Image.new("RGB", (_PAIRS_PER_ROW * width, n_rows * height), "white")
    canvas = ImageDraw.Draw(sheet)
    for k, (caption, tiles) in enumerate(pairs):
        top, left = (k // _PAIRS_PER_ROW) * height, (k % _PAIRS_PER_ROW) * width
        canvas.text((left + 4, top + 4), caption, font=ImageFont.load_default(13), fill="black")
        for i, tile in enumerate(tiles):
            sheet.paste(tile, (left + i * (_TILE + _GAP), top + _CAPTION))
    return sheet
