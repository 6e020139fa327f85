"""Missing vertices against published figures: ``python -m benchmarks.restoration BENCH``.

BENCH is a folder with `meshes/stanford_bunny.ply` and `meshes/fandisk.ply`. Each mesh is scaled to the unit cube, a
share of its vertices is hidden at random, and what is restored is compared with what was there. Two figures are given,
both over the restored vertices: the root mean square error of a coordinate, as in the paper, most of which is sliding
along the surface; and the root mean square distance to the true surface.

The paper's fandisk has about 6,500 vertices. `fandisk_6k` is the benchmark's one brought to that count by MeshLab's
isotropic remeshing; its connectivity is not that of the paper's. `relief_gyroid` is measured where it is asked for.
"""

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console

from benchmarks.quality.tables import NOTHING, Table
from quadpatch.formats.reading import read_scan
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.weld import weld
from quadpatch.model_choice import choose_model
from quadpatch.options import RepairOptions
from quadpatch.progress import no_progress
from quadpatch.restoration.least_squares import extend_smoothly
from quadpatch.restoration.restore import restore
from quadpatch.types import BoolArray, TriangleMesh, Vertices

SHARES = (0.2, 0.5, 0.7)
MODELS = ("self", "general-dictionary")
# Mean edge of the remeshed fandisk, as a share of the longest side of the part.
_EDGE = 0.0197

# Error of a coordinate, times 1000, by share: the paper's table, and what it states of Zhong (2016).
PUBLISHED = {
    "stanford_bunny": {0.2: (1.11, 19.0), 0.5: (1.62, 22.0)},
    "fandisk": {0.2: (1.32, 8.3), 0.5: (1.34, 12.0)},
    "fandisk_6k": {0.2: (1.32, 8.3), 0.5: (1.34, 12.0)},
}


@dataclass(frozen=True)
class Score:
    """Errors of restored vertices: of a coordinate, and of the distance to the surface, times 1000."""

    coordinate: float
    distance: float

    @classmethod
    def of(cls, truth: TriangleMesh, restored: Vertices, missing: BoolArray) -> "Score":
        """Compare restored vertices (of all, (n, 3)) with the truth."""
        error = (restored - truth.vertices)[missing]
        distance = distance_to_mesh(np.ascontiguousarray(restored[missing]), truth)
        return cls(1000 * float(np.sqrt((error**2).mean())), 1000 * float(np.sqrt((distance**2).mean())))

    def cells(self) -> list[str]:
        """For a table."""
        return [f"{self.coordinate:.3f}", f"{self.distance:.4f}"]


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and print."""
    options = _parser().parse_args(arguments)
    console = Console(width=160)
    rows: list[list[str]] = []
    for name in options.mesh or list(PUBLISHED):
        mesh = MESHES[name](options.bench)
        for share in options.share or SHARES:
            rows += _rows(name, mesh, share, options.model or MODELS)
            console.print("  ".join(rows[-1]))
    title = "missing vertices, errors x 1e-3 of the longest side"
    columns = ("mesh", "missing", "method", "coordinate", "distance", "expected", "placement", "patches", "CPU s")
    table = Table(title, columns, rows)
    console.print(table.to_rich())
    if options.output is not None:
        options.output.write_text(table.to_markdown())


def _rows(name: str, mesh: TriangleMesh, share: float, models: Sequence[str]) -> list[list[str]]:
    """Rows of one mesh and share: the peers, then each model."""
    missing = hidden_at_random(len(mesh.vertices), share)
    head = [f"{name}, {len(mesh.vertices):,} vertices", f"{share:.0%}"]
    paper, zhong = PUBLISHED.get(name, {}).get(share, (None, None))
    rows = [
        [*head, label, f"{figure:.2f}", *[NOTHING] * 5]
        for label, figure in (("Zhong 2016", zhong), ("the paper", paper))
        if figure is not None
    ]
    smooth = extend_smoothly(mesh.triangles, missing, mesh.vertices)
    rows.append([*head, "least-squares mesh", *Score.of(mesh, smooth, missing).cells(), *[NOTHING] * 4])
    damaged = TriangleMesh(np.where(missing[:, None], np.nan, mesh.vertices), mesh.triangles)
    for model in models:
        inpainter, _ = choose_model(model, RepairOptions(), no_progress, None)
        start = time.process_time()
        result = restore(damaged, missing, inpainter)
        seconds = time.process_time() - start
        expected = 1000 * float(np.sqrt((result.expected_error[missing] ** 2).mean()))
        cells = [f"{expected:.4f}", result.placement, f"{result.blend_factor:.2f}", f"{seconds:.0f}"]
        rows.append([*head, model, *Score.of(mesh, result.vertices, missing).cells(), *cells])
    return rows


def hidden_at_random(n_vertices: int, share: float, seed: int = 0) -> BoolArray:
    """Draw which vertices (n_vertices,) are missing."""
    missing = np.zeros(n_vertices, np.bool_)
    drawn = np.random.default_rng(seed).choice(n_vertices, round(share * n_vertices), replace=False)
    missing[drawn] = True
    return missing


def in_unit_cube(mesh: TriangleMesh) -> TriangleMesh:
    """Scale a mesh so that the longest side of its box is 1."""
    low = mesh.vertices.min(axis=0)
    return TriangleMesh((mesh.vertices - low) / np.ptp(mesh.vertices, axis=0).max(), mesh.triangles)


def _mesh(name: str) -> Callable[[Path], TriangleMesh]:
    def load(bench: Path) -> TriangleMesh:
        scan = read_scan(bench / "meshes" / f"{name}.ply")
        return in_unit_cube(weld(scan.vertices, scan.triangles).mesh)

    return load


def _coarse_fandisk(bench: Path) -> TriangleMesh:
    import pymeshlab  # noqa: PLC0415  slow to load, and not needed for the other meshes

    fine = _mesh("fandisk")(bench)
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(fine.vertices, fine.triangles))
    meshes.meshing_isotropic_explicit_remeshing(iterations=10, targetlen=pymeshlab.PureValue(_EDGE), featuredeg=25)
    made = meshes.current_mesh()
    return in_unit_cube(TriangleMesh(made.vertex_matrix(), made.face_matrix().astype(np.int64)))


MESHES: dict[str, Callable[[Path], TriangleMesh]] = {
    "stanford_bunny": _mesh("stanford_bunny"),
    "fandisk": _mesh("fandisk"),
    "fandisk_6k": _coarse_fandisk,
    "relief_gyroid": _mesh("relief_gyroid"),
}


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="benchmarks.restoration", description="Missing vertices, restored.")
    parser.add_argument("bench", type=Path, metavar="BENCH", help="folder with meshes/stanford_bunny.ply, ...")
    parser.add_argument("--mesh", action="append", choices=list(MESHES), help="only this one; may be repeated")
    parser.add_argument("--share", action="append", type=float, help="of missing vertices; may be repeated")
    parser.add_argument("--model", action="append", help="self, smooth, or a dictionary; may be repeated")
    parser.add_argument("--output", type=Path, help="write the table as Markdown")
    return parser


if __name__ == "__main__":
    main()
