"""Meshes of the user's own: any format that can be repaired, cleaned, and normalised as the bench's are."""

from pathlib import Path

import numpy as np

from benchmarks.quality.bench import Bench, BenchError, Shape
from quadpatch.formats.detection import KNOWN
from quadpatch.formats.reading import read_scan
from quadpatch.mesh.weld import weld
from quadpatch.types import IntArray, TriangleMesh, Triangles


def own_shapes(bench: Bench, folder: Path, output: Path) -> list[Shape]:
    """Prepare the meshes of a folder; the peers' figures are left to be measured.

    Raises
    ------
    BenchError
        If there is no mesh.
    QuadpatchError
        If one can't be read.
    """
    files = sorted(path for path in folder.iterdir() if path.suffix.lower()[1:] in KNOWN) if folder.is_dir() else []
    if not files:
        raise BenchError(f"no mesh in {folder}")
    shapes = []
    for path in files:
        truth = output / "truth" / f"{path.stem}.ply"
        truth.parent.mkdir(parents=True, exist_ok=True)
        bench.write(truth, prepare(path))
        shapes.append(Shape(path.stem, truth, {}))
    return shapes


def prepare(path: Path) -> TriangleMesh:
    """Read a file, join repeated vertices, drop what spoils a mesh, and normalise it."""
    scan = read_scan(path)
    welded = weld(scan.vertices, scan.triangles).mesh
    return normalised(TriangleMesh(welded.vertices, clean(welded.triangles)))


def clean(triangles: Triangles) -> Triangles:
    """Drop repeated triangles, and all at an edge of more than two: no surface has such."""
    distinct = triangles[np.sort(np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)[1])]
    edges = np.sort(distinct[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, edge, count = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    crowded = (count[edge.ravel()] > 2).reshape(-1, 3).any(axis=1)
    kept: IntArray = distinct[~crowded]
    return kept


def normalised(mesh: TriangleMesh) -> TriangleMesh:
    """Scale the bounding box to a longest side of 1 around the origin; vertices of no triangle are dropped."""
    used, triangles = np.unique(mesh.triangles, return_inverse=True)
    vertices = mesh.vertices[used]
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return TriangleMesh((vertices - 0.5 * (low + high)) / (high - low).max(), triangles.reshape(-1, 3))
