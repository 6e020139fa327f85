"""Close-ups of holes: punched, true, and repaired in one way or in several, side by side."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.quality.bench import Bench, Case
from benchmarks.quality.measurement import Method, measure, repaired_path
from benchmarks.quality.results import Results
from benchmarks.quality.sheets import TILE, Row, compose
from quadpatch.formats.reading import read_scan
from quadpatch.mesh.raycast import RayScene
from quadpatch.preview.camera import Camera, view_of
from quadpatch.preview.invented import TINT
from quadpatch.preview.parts import main_pieces, part_of
from quadpatch.preview.shading import CLAY, Clay
from quadpatch.preview.viewpoints import close_ups, is_inside_out
from quadpatch.types import BoolArray, FloatArray, TriangleMesh, Vertices

PUNCHED, TRUTH, REPAIRED = "punched", "truth", "repaired"
# How much of the tint of invented surface is mixed into the clay: enough to see it, too little to hide its shape.
_STRENGTH = 0.35


@dataclass(frozen=True)
class DrawnCase:
    """The meshes of a case, ready to be drawn, and one of its repairs to find views of it.

    Attributes
    ----------
    clays : mapping of str to Clay
        `punched`, `truth`, and each repair by its name.
    repaired : TriangleMesh
        The last repair.
    scene : RayScene
        Of it.
    is_new : (n_triangles,) bool
        True for the triangles of it that fill a hole.
    radius : float
        Of the holes, in mesh units.
    """

    clays: Mapping[str, Clay]
    repaired: TriangleMesh
    scene: RayScene
    is_new: BoolArray
    radius: float

    @classmethod
    def of(cls, bench: Bench, case: Case, repairs: Mapping[str, Path]) -> "DrawnCase":
        """Read the files of a case and its repairs, at least one, whose first triangles are those of the punched."""
        punched, truth = bench.read(case.punched), bench.read(case.shape.truth)
        is_flipped = is_turned_inside_out(punched)
        clays = {PUNCHED: clay_of(turned(punched, is_flipped)), TRUTH: clay_of(turned(truth, is_flipped))}
        for name, path in repairs.items():
            scan = read_scan(path)
            repaired = turned(TriangleMesh(scan.vertices, scan.triangles), is_flipped)
            is_new = np.arange(len(repaired.triangles)) >= len(punched.triangles)
            clays[name] = clay_of(repaired, is_new)
        return cls(clays, repaired, RayScene(repaired), is_new, float(case.radius))

    def tiles(self, centre: Vertices) -> dict[str, FloatArray]:
        """Draw all meshes around the centre (3,) of a hole from where its fill shows, by name."""
        camera = self._camera(centre)
        return {name: clay.draw(camera, (TILE, TILE)) for name, clay in self.clays.items()}

    def _camera(self, centre: Vertices) -> Camera:
        corners = self.repaired.vertices[self.repaired.triangles]
        is_near = np.linalg.norm(corners.mean(axis=1) - centre, axis=1) < 1.5 * self.radius
        fill = part_of(self.repaired, np.flatnonzero(self.is_new & is_near))
        mean = fill.area_vectors.sum(axis=0)
        towards = mean / max(float(np.linalg.norm(mean)), float(np.finfo(np.float64).tiny))
        upright = view_of(fill.corners, towards, 1.0)
        return close_ups(self.scene, [fill], upright, 1)[0]


def is_turned_inside_out(mesh: TriangleMesh) -> bool:
    """Tell whether the inside of the surface is what mostly shows from outside, as on the bunny of the bench."""
    return is_inside_out(RayScene(mesh), part_of(mesh, main_pieces(mesh)))


def turned(mesh: TriangleMesh, is_flipped: bool) -> TriangleMesh:
    """Turn the triangles over if they are flipped; their order stays."""
    return TriangleMesh(mesh.vertices, mesh.triangles[:, ::-1]) if is_flipped else mesh


def clay_of(mesh: TriangleMesh, is_new: BoolArray | None = None) -> Clay:
    """Prepare a mesh for drawing; triangles (n_triangles,) that are new get a tint."""
    colours = np.tile(CLAY, (len(mesh.triangles), 1))
    if is_new is not None:
        colours[is_new] += _STRENGTH * (TINT - CLAY)
    return Clay(mesh, RayScene(mesh), colours)


def draw_extremes(bench: Bench, case: Case, method: Method, results: Results, folder: Path) -> Path:
    """Draw the worst and the best hole of a measured repair, by true error, as PNG; once for each result."""
    found = measure(bench, case, method, results)
    path = folder / f"{case.shape.name}_{case.radius}_{method.name}.png"
    repaired = repaired_path(case, method)
    holes = sorted(found["per_hole"], key=lambda hole: float(hole["true_error"]))
    is_drawn = path.is_file() and repaired.is_file() and path.stat().st_mtime > repaired.stat().st_mtime
    if not holes or is_drawn or not repaired.is_file():
        return path
    drawn = DrawnCase.of(bench, case, {REPAIRED: repaired})
    rows = [
        Row(_caption(name, case, method, hole), drawn.tiles(np.array(hole["centre"])))
        for name, hole in (("worst", holes[-1]), ("best", holes[0]))
    ]
    path.parent.mkdir(parents=True, exist_ok=True)
    compose(rows).save(path, format="PNG", compress_level=6)
    return path


def _caption(name: str, case: Case, method: Method, hole: dict[str, Any]) -> str:
    confidence = "" if hole["confidence"] is None else f", confidence {hole['confidence']:.2f}"
    return (
        f"{case.shape.name}, radius {case.radius}, {method.name}: {name} hole ({hole['id']}), "
        f"error {percent_of_radius(case, hole):.1f} % of the radius, {hole['verdict']}{confidence}"
    )


def percent_of_radius(case: Case, hole: Mapping[str, Any]) -> float:
    """Give the true error of a measured hole in percent of its radius."""
    return 100 * float(hole["true_error"]) / float(case.radius)
