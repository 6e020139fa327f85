"""A relief with holes whose surface is known: made by code, to show what learning adds.

It is a section of a gyroid on irregular vertices, so that no hole has a twin.

Tested in `tests/onebox/test_relief.py`.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.raycast import RayScene
from quadpatch.preview.camera import view_of
from quadpatch.preview.invented import TINT
from quadpatch.preview.parts import part_of
from quadpatch.preview.png import to_pixels, write_png
from quadpatch.preview.shading import CLAY, Clay
from quadpatch.types import FloatArray, TriangleMesh

_N_SIDE, _WAVES, _DEPTH = 180, 12, 0.025
_CENTRES = np.array([[x, y, 0.0] for x in (-0.4, 0.03, 0.4) for y in (-0.4, -0.04, 0.4)])
_RADIUS = 0.085
_TILE, _GAP, _CAPTION = 420, 8, 26
# How much of the tint of invented surface is mixed into the clay: enough to see it, too little to hide its shape.
_STRENGTH = 0.35


@dataclass(frozen=True)
class PunchedRelief:
    """The relief before and after holes were cut into it.

    Attributes
    ----------
    truth, damaged : TriangleMesh
        With the same vertices.
    """

    truth: TriangleMesh
    damaged: TriangleMesh

    @classmethod
    def make(cls) -> "PunchedRelief":
        """Make it; it has the same bits every time."""
        truth = _relief()
        return cls(truth, _without_disks(truth))

    def error(self, repaired: TriangleMesh) -> float:
        """Mean distance of the new vertices of a repair to the surface that was cut away, in radii of the holes."""
        new = repaired.vertices[len(self.damaged.vertices) :]
        return float(distance_to_mesh(new, self.truth).mean()) / _RADIUS

    def draw(self, repairs: dict[str, TriangleMesh], path: Path) -> None:
        """Draw the damaged relief and its repairs beside each other as PNG, with the error of each."""
        n_measured = len(self.damaged.triangles)
        tiles = [("with holes", _drawn(self.damaged, n_measured))]
        for name, repaired in repairs.items():
            caption = f"{name}: off by {self.error(repaired):.1%} of the holes' radius"
            tiles.append((caption, _drawn(repaired, n_measured)))
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
