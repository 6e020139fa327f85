"""Close-ups of the worst and the best hole of a repair: punched, true, repaired, side by side.

Tested in `tests/benchmarks/quality/test_main.py`.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from benchmarks.quality.bench import Bench, Case
from benchmarks.quality.measurement import Method, measure, repaired_path
from benchmarks.quality.results import Results
from quadpatch.formats.reading import read_scan
from quadpatch.mesh.raycast import RayScene
from quadpatch.preview.camera import Camera, view_of
from quadpatch.preview.pair import TINT
from quadpatch.preview.parts import part_of
from quadpatch.preview.shading import CLAY, Clay
from quadpatch.preview.viewpoints import close_ups
from quadpatch.types import BoolArray, FloatArray, TriangleMesh, Vertices

_TILE = 360
_GAP = 6
_CAPTION = 24
# How much of the tint of invented surface is mixed into the clay: enough to see it, too little to hide its shape.
_STRENGTH = 0.35
_COLUMNS = ("punched", "truth", "repaired")


@dataclass(frozen=True)
class _Stage:
    """The three meshes, ready to be drawn, and the repaired one to find views of it."""

    clays: tuple[Clay, Clay, Clay]
    repaired: TriangleMesh
    scene: RayScene
    is_new: BoolArray


def draw_extremes(bench: Bench, case: Case, method: Method, results: Results, folder: Path) -> Path:
    """Draw the worst and the best hole of a measured repair, by true error, as PNG; once for each result."""
    found = measure(bench, case, method, results)
    path = folder / f"{case.shape.name}_{case.radius}_{method.name}.png"
    repaired = repaired_path(case, method)
    holes = sorted(found["per_hole"], key=lambda hole: float(hole["true_error"]))
    is_drawn = path.is_file() and repaired.is_file() and path.stat().st_mtime > repaired.stat().st_mtime
    if not holes or is_drawn or not repaired.is_file():
        return path
    stage = _set_up(bench, case, repaired)
    rows = [
        (_caption(name, case, method, hole), _tiles(stage, case, hole))
        for name, hole in (("worst", holes[-1]), ("best", holes[0]))
    ]
    path.parent.mkdir(parents=True, exist_ok=True)
    _compose(rows).save(path, format="PNG", compress_level=6)
    return path


def _set_up(bench: Bench, case: Case, repaired: Path) -> _Stage:
    punched, truth = bench.read(case.punched), bench.read(case.shape.truth)
    scan = read_scan(repaired)
    after = TriangleMesh(scan.vertices, scan.triangles)
    is_new = np.arange(len(after.triangles)) >= len(punched.triangles)
    scene = RayScene(after)
    tinted = np.where(is_new[:, None], CLAY + _STRENGTH * (TINT - CLAY), CLAY)
    grey = [Clay(mesh, RayScene(mesh), np.tile(CLAY, (len(mesh.triangles), 1))) for mesh in (punched, truth)]
    return _Stage((grey[0], grey[1], Clay(after, scene, tinted)), after, scene, is_new)


def _tiles(stage: _Stage, case: Case, hole: dict[str, Any]) -> list[FloatArray]:
    camera = _camera(stage, np.array(hole["centre"]), float(case.radius))
    return [clay.draw(camera, (_TILE, _TILE)) for clay in stage.clays]


def _camera(stage: _Stage, centre: Vertices, radius: float) -> Camera:
    """Look at the fill around a centre from where it shows."""
    corners = stage.repaired.vertices[stage.repaired.triangles]
    is_near = np.linalg.norm(corners.mean(axis=1) - centre, axis=1) < 1.5 * radius
    fill = part_of(stage.repaired, np.flatnonzero(stage.is_new & is_near))
    mean = fill.area_vectors.sum(axis=0)
    towards = mean / max(float(np.linalg.norm(mean)), float(np.finfo(np.float64).tiny))
    upright = view_of(fill.corners, towards, 1.0)
    return close_ups(stage.scene, [fill], upright, 1)[0]


def _caption(name: str, case: Case, method: Method, hole: dict[str, Any]) -> str:
    share = 100 * hole["true_error"] / float(case.radius)
    confidence = "" if hole["confidence"] is None else f", confidence {hole['confidence']:.2f}"
    return (
        f"{case.shape.name}, radius {case.radius}, {method.name}: {name} hole ({hole['id']}), error {share:.1f} % of "
        f"the radius, {hole['verdict']}{confidence}"
    )


def _compose(rows: list[tuple[str, list[FloatArray]]]) -> Image.Image:
    width = len(_COLUMNS) * (_TILE + _GAP) - _GAP
    sheet = Image.new("RGB", (width, len(rows) * (2 * _CAPTION + _TILE + _GAP)), "white")
    canvas = ImageDraw.Draw(sheet)
    top = 0
    for caption, tiles in rows:
        canvas.text((4, top + 5), caption, font=ImageFont.load_default(14), fill="black")
        top += _CAPTION
        for k, (tile, name) in enumerate(zip(tiles, _COLUMNS, strict=True)):
            left = k * (_TILE + _GAP)
            canvas.text((left + 4, top + 4), name, font=ImageFont.load_default(13), fill="grey")
            sheet.paste(Image.fromarray(np.round(255 * tile).astype(np.uint8)), (left, top + _CAPTION))
        top += _CAPTION + _TILE + _GAP
    return sheet
