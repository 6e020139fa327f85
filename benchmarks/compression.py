"""Bytes of encoded meshes beside edge collapse and Draco at the same PSNR: `python -m benchmarks.compression BENCH`.

Each mesh of the benchmark is encoded with several promised errors, decoded again, and measured by its vertices: PSNR =
20 log10(diagonal of the bounding box / root mean square distance of the mesh's vertices from the decoded surface). The
peer is MeshLab's quadric edge collapse to many sizes, each encoded by Draco with 9 to 13 bits; of these the smallest
file counts that is at least as close, interpolated between neighbours on the convex hull of (PSNR, log bytes).

`--mesh NAME` chooses meshes, `--error X` promised errors (parts of the diagonal), `--dome N` adds the bumpy dome of
`BENCH/large.py` with so many triangles. Needs DracoPy, of the extra `bench`.
"""

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import DracoPy
import numpy as np
import pymeshlab

from quadpatch.compression.decode import decode_mesh
from quadpatch.compression.encode import EncodeOptions
from quadpatch.formats.reading import read_scan
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.measures import diagonal
from quadpatch.mesh.weld import weld
from quadpatch.tasks.encode import encode_file
from quadpatch.types import FloatArray, TriangleMesh

MESHES = ("stanford_bunny", "relief_gyroid")
ERRORS = (0.004, 0.002, 0.001)
BITS = (9, 10, 11, 12)
# Vertices that edge collapse leaves, as parts of those of the mesh.
SHARES = (0.005, 0.01, 0.015, 0.02, 0.03, 0.04, 0.06, 0.08, 0.11, 0.15)
COLUMNS = (
    "mesh | vertices | max error | bytes | bits a vertex | PSNR | Draco bytes | ours / Draco | entity factor"
    " | corrected patches"
)


def main() -> None:
    """Print the table, row by row."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bench", type=Path)
    parser.add_argument("--mesh", action="append")
    parser.add_argument("--error", action="append", type=float)
    parser.add_argument("--dome", type=int, default=0)
    parser.add_argument("--model", default="self")
    given = parser.parse_args()
    print(f"| {COLUMNS} |\n| --- |" + " ---: |" * COLUMNS.count("|"))  # noqa: T201
    with tempfile.TemporaryDirectory() as folder:
        for path in _paths(given, Path(folder)):
            for row in rows(path, given.error or list(ERRORS), Path(folder) / "out.qpz", given.model):
                print(f"| {' | '.join(row)} |", flush=True)  # noqa: T201


def _paths(given: Any, folder: Path) -> Iterator[Path]:
    for name in given.mesh or (() if given.dome else MESHES):
        yield given.bench / "meshes" / f"{name}.ply"
    if given.dome:
        path = folder / "dome.ply"
        subprocess.run([sys.executable, str(given.bench / "large.py"), str(given.dome), str(path)], check=True)
        yield path


def rows(path: Path, errors: list[float], output: Path, model: str) -> Iterator[list[str]]:
    """Measure one mesh with several promised errors, given as parts of its diagonal."""
    scan = read_scan(path)
    mesh = weld(scan.vertices, scan.triangles, "auto").mesh
    peer = draco_files(mesh)
    for error in errors:
        report = encode_file(path, output, model, EncodeOptions(error * diagonal(mesh))).report
        found = decode_mesh(output.read_bytes(), None).mesh  # type: ignore[arg-type]
        ours = vertex_psnr(mesh, found)
        draco = bytes_at(peer, ours)
        yield [
            path.stem,
            f"{len(scan.vertices):,}",
            f"{error:g}",
            f"{report['bytes']:,}",
            f"{8 * report['bytes_per_vertex']:.2f}",
            f"{ours:.1f}",
            "" if draco is None else f"{draco:,.0f}",
            "" if draco is None else f"{report['bytes'] / draco:.2f}",
            f"{report['entity_factor']:.1f} ({report['entity_factor_with_indices']:.1f})",
            f"{report['patches']['corrected']} of {report['patches']['count']}",
        ]


def vertex_psnr(mesh: TriangleMesh, decoded: TriangleMesh) -> float:
    """PSNR of a decoded surface, in decibels, over the vertices of the mesh."""
    distance = distance_to_mesh(mesh.vertices[np.unique(mesh.triangles)], decoded)
    return float(20 * np.log10(diagonal(mesh) / np.sqrt((distance**2).mean())))


def draco_files(mesh: TriangleMesh) -> FloatArray:
    """Files of edge collapse and Draco: rows of PSNR and bytes."""
    found = []
    for share in SHARES:
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.triangles))
        meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=round(share * len(mesh.triangles)))
        left = meshes.current_mesh()
        for bits in BITS:
            data = DracoPy.encode(
                left.vertex_matrix(), left.face_matrix(), quantization_bits=bits, compression_level=10
            )
            back = DracoPy.decode(data)
            decoded = TriangleMesh(np.asarray(back.points, np.float64), np.asarray(back.faces, np.int64))
            found.append((vertex_psnr(mesh, decoded), float(len(data))))
    return np.array(found)


def bytes_at(files: FloatArray, psnr: float) -> float | None:
    """Bytes that the best of some files would take at a PSNR; None beyond the best of them."""
    ranked = files[np.lexsort((-files[:, 0], files[:, 1]))]
    best = [ranked[0]]
    for row in ranked[1:]:
        if row[0] > best[-1][0]:
            best.append(row)
    front = np.array(best)
    if not front[0, 0] <= psnr <= front[-1, 0]:
        return None
    return float(np.exp(np.interp(psnr, front[:, 0], np.log(front[:, 1]))))


if __name__ == "__main__":
    main()
