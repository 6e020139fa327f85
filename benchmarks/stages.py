"""Seconds per stage from base surface to connectivity, on a mesh of a chosen size.

Run ``python -m benchmarks.stages`` for a generated relief, or with the paths of meshes. Prints one table per mesh;
times are wall-clock and mean something only on an idle machine.

Tested in `tests/benchmarks/test_commands.py`.
"""

import argparse
import resource
import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import numpy as np
from rich.console import Console
from rich.table import Table

from quadpatch.formats.reading import read_scan
from quadpatch.mesh.measures import diagonal
from quadpatch.mesh.normals import vertex_normals
from quadpatch.mesh.raycast import RayScene
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.mesh.weld import weld
from quadpatch.patches.connectivity import vertices_in_patches
from quadpatch.patches.folding import is_unfolded
from quadpatch.patches.height_map import sample_height_maps
from quadpatch.patches.seeds import project_seeds, seed_points
from quadpatch.quads.frames import quad_frames
from quadpatch.quads.mesher import quadrangulate
from quadpatch.types import TriangleMesh

_Result = TypeVar("_Result")


class Stopwatch:
    """A table of stages: what each made, and its seconds."""

    def __init__(self, title: str) -> None:
        self.table = Table(title=title)
        for name in ("stage", "result", "seconds"):
            self.table.add_column(name, justify="left" if name == "stage" else "right")

    def time(self, stage: str, work: Callable[[], _Result], result: Callable[[_Result], str]) -> _Result:
        """Run and time one stage."""
        start = time.perf_counter()
        made = work()
        self.table.add_row(stage, result(made), f"{time.perf_counter() - start:.3f}")
        return made


def relief(n: int) -> TriangleMesh:
    """Waves on a square of n x n vertices."""
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    z = 0.1 * np.sin(4 * x) * np.cos(3 * y) + 0.01 * np.sin(40 * x + 25 * y)
    index = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return TriangleMesh(np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1), triangles)


def measure(name: str, mesh: TriangleMesh, arguments: argparse.Namespace) -> Table:
    """Time every stage on one mesh."""
    watch = Stopwatch(f"{name}: {len(mesh.vertices):,} vertices, {len(mesh.triangles):,} triangles")
    length, resolution = arguments.length * diagonal(mesh), arguments.resolution
    base_surface = watch.time("smooth", lambda: laplacian_smooth(mesh, 30), lambda _: "")
    quads = watch.time(
        "quadrangulate", lambda: quadrangulate(base_surface, length), lambda made: f"{len(made.quads):,} quads"
    )
    frames = watch.time("frames", lambda: quad_frames(quads), lambda _: "")
    seeds = seed_points(quads, frames, arguments.overlap)
    scene = watch.time("ray scene", lambda: RayScene(mesh), lambda _: "")
    seeds = watch.time(
        "project seeds", lambda: project_seeds(scene, mesh, seeds, length / 2), lambda s: f"{len(s):,} seeds"
    )
    measured = np.zeros(len(mesh.triangles), dtype=bool)
    patches = watch.time(
        "height maps",
        lambda: sample_height_maps(scene, mesh, measured, seeds, length, resolution),
        lambda made: f"{made.heights.size:,} bins, {made.seen.mean():.1%} seen",
    )
    watch.time("folding", lambda: is_unfolded(patches), lambda unfolded: f"{unfolded.mean():.1%} are height maps")
    normals = vertex_normals(mesh.vertices, mesh.triangles)
    watch.time(
        "connectivity",
        lambda: vertices_in_patches(mesh.vertices, normals, patches),
        lambda made: f"{len(made.vertex) / len(mesh.vertices):.1f} patches per vertex",
    )
    peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    watch.table.caption = f"peak memory of the process so far {peak_mb:,.0f} MB"
    return watch.table


def main() -> None:
    """Read the command line and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0] if __doc__ else None)
    parser.add_argument("meshes", nargs="*", type=Path, help="mesh files; none: a generated relief")
    parser.add_argument("--vertices", type=int, default=64_000, help="of the generated relief")
    parser.add_argument("--length", type=float, default=0.05, help="patch length over the diagonal of the bounding box")
    parser.add_argument("--resolution", type=int, default=24, help="bins along one side of a patch")
    parser.add_argument("--overlap", type=int, default=2, help="offset patches towards each corner of a quad")
    arguments = parser.parse_args()
    console = Console()
    if not arguments.meshes:
        console.print(measure("relief", relief(round(arguments.vertices**0.5)), arguments))
    for path in arguments.meshes:
        scan = read_scan(path)
        console.print(measure(path.name, weld(scan.vertices, scan.triangles).mesh, arguments))


if __name__ == "__main__":
    main()
