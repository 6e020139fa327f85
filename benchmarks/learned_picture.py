"""Draw what learning adds: a procedural relief with holes, filled by geometry alone and by a dictionary of the relief.

    python -m benchmarks.learned_picture docs/images/learned.png

The relief is a section of a gyroid on irregular vertices; each fill's caption has its mean distance from the surface
that was cut away.
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from quadpatch.inpainters.dictionary import SelfDictionary
from quadpatch.inpainters.inpainter import Inpainter
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.raycast import RayScene
from quadpatch.options import RepairOptions
from quadpatch.preview.camera import view_of
from quadpatch.preview.pair import TINT
from quadpatch.preview.parts import part_of
from quadpatch.preview.png import to_pixels, write_png
from quadpatch.preview.shading import CLAY, Clay
from quadpatch.recipes.default import inpaint
from quadpatch.recipes.result import Repair
from quadpatch.types import FloatArray, TriangleMesh

_N_SIDE, _WAVES, _DEPTH = 180, 12, 0.025
_CENTRES = np.array([[x, y, 0.0] for x in (-0.4, 0.03, 0.4) for y in (-0.4, -0.04, 0.4)])
_RADIUS = 0.085
_TILE, _GAP, _CAPTION = 420, 8, 26
# How much of the tint of invented surface is mixed into the clay: enough to see it, too little to hide its shape.
_STRENGTH = 0.35


def draw(path: Path) -> None:
    """Repair the relief twice and draw both repairs beside the damaged one, as PNG."""
    truth = _relief()
    damaged = _without_disks(truth)
    fills: list[tuple[str, Inpainter | None]] = [("geometry alone", None), ("learned from the mesh", SelfDictionary())]
    tiles = [("with holes", _drawn(damaged, len(damaged.triangles)))]
    for name, inpainter in fills:
        repair = inpaint(damaged, inpainter, RepairOptions())
        caption = f"{name}: off by {_mean_error(repair, truth) / _RADIUS:.1%} of the holes' radius"
        tiles.append((caption, _drawn(repair.filled.mesh, len(damaged.triangles))))
    write_png(path, _sheet(tiles))


def _relief() -> TriangleMesh:
    step = 2.0 / (_N_SIDE - 1)
    grid = np.stack(np.meshgrid(*2 * [np.linspace(-1.0, 1.0, _N_SIDE)]), axis=2).reshape(-1, 2)
    x, y = (grid + np.random.default_rng(0).uniform(-0.2 * step, 0.2 * step, grid.shape)).T
    u, v = np.pi * _WAVES * x, np.pi * _WAVES * y
    z = _DEPTH * (np.sin(u) * np.cos(v) + np.sin(v) * np.cos(0.3) + np.sin(0.3) * np.cos(u))
    corner = (np.arange(_N_SIDE - 1)[:, None] * _N_SIDE + np.arange(_N_SIDE - 1)).ravel()
    a, b, c, d = corner, corner + 1, corner + _N_SIDE + 1, corner + _N_SIDE
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return TriangleMesh(np.stack([x, y, z], axis=1), triangles)


def _without_disks(mesh: TriangleMesh) -> TriangleMesh:
    distance = np.linalg.norm(mesh.vertices[:, None, :2] - _CENTRES[None, :, :2], axis=2).min(axis=1)
    return TriangleMesh(mesh.vertices, mesh.triangles[(distance >= _RADIUS)[mesh.triangles].all(axis=1)])


def _mean_error(repair: Repair, truth: TriangleMesh) -> float:
    new = repair.filled.mesh.vertices[repair.filled.n_measured_vertices :]
    return float(distance_to_mesh(new, truth).mean())


def _drawn(mesh: TriangleMesh, n_measured: int) -> FloatArray:
    is_new = np.arange(len(mesh.triangles)) >= n_measured
    clay = Clay(mesh, RayScene(mesh), np.where(is_new[:, None], CLAY + _STRENGTH * (TINT - CLAY), CLAY))
    middle = np.abs(mesh.vertices[mesh.triangles][:, :, :2]).max(axis=(1, 2)) < 0.6
    camera = view_of(part_of(mesh, np.flatnonzero(middle)).corners, np.array([0.15, -0.45, 1.0]) / 1.107, 1.0)
    return clay.draw(camera, (_TILE, _TILE))


def _sheet(tiles: list[tuple[str, FloatArray]]) -> Image.Image:
    sheet = Image.new("RGB", (len(tiles) * (_TILE + _GAP) - _GAP, _CAPTION + _TILE), "white")
    pen = ImageDraw.Draw(sheet)
    for k, (caption, tile) in enumerate(tiles):
        left = k * (_TILE + _GAP)
        pen.text((left, 4), caption, font=ImageFont.load_default(15), fill=(60, 60, 60))
        sheet.paste(Image.fromarray(to_pixels(tile)), (left, _CAPTION))
    return sheet


if __name__ == "__main__":
    draw(Path(sys.argv[1]))
