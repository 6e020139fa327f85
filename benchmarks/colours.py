"""Colours of new vertices beside harmonic ones, on coloured meshes that holes were punched into.

    python -m benchmarks.colours BENCH [MESH.ply ...]

Measured are the mesh of the bench with colours, or others given. Each is scaled to a longest side of 1 and punched as
the bench does. Two figures are printed, those of harmonic colours in front: PSNR of the new vertices against the
nearest vertex of the truth, in dB, and the gradient energy of the new surface per area over that of what was punched
out: 1 keeps all of it, a blur nearly nothing; nan where the truth has no gradient.

Tested in `tests/benchmarks/test_colours.py`.
"""

import argparse
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from benchmarks.quality.bench import RADII, Bench
from quadpatch.formats.reading import read_scan
from quadpatch.mesh.normals import area_vectors
from quadpatch.options import RepairOptions
from quadpatch.repair import repair_file
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices

SCAN = Path("colour") / "pizza_gloss.ply"


@dataclass(frozen=True)
class ColouredMesh:
    """A mesh and the colours (n, 3) of its vertices, 0..255."""

    mesh: TriangleMesh
    colours: FloatArray


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench", type=Path, help="folder with bench.py")
    parser.add_argument("mesh", nargs="*", type=Path, help=f"coloured PLY; else {SCAN} of the bench")
    parser.add_argument("--radius", nargs="*", default=RADII, help="of the holes, in shares of the longest side")
    parser.add_argument("--seed", type=int, default=0, help="of the repairs")
    arguments = parser.parse_args()
    bench = Bench.open(arguments.bench)
    print("| mesh | radius | holes | colours | PSNR, dB | gradient energy kept | expected by calibration |")  # noqa: T201
    print("| --- | ---: | ---: | --- | ---: | ---: | ---: |")  # noqa: T201
    for path in arguments.mesh or [arguments.bench / SCAN]:
        for radius in arguments.radius:
            print(row(bench, path, radius, arguments.seed), flush=True)  # noqa: T201


def row(bench: Bench, path: Path, radius: str, seed: int = 0) -> str:
    """Punch a mesh and repair it, with harmonic colours and with those that calibration chooses."""
    truth = normalised(read_coloured(path))
    with tempfile.TemporaryDirectory() as folder:
        whole, punched = Path(folder) / "truth.ply", Path(folder) / "punched.ply"
        write_coloured(whole, truth)
        n_holes = len(bench.script.punch(whole, float(radius), Path(folder))["holes"])
        remaining = bench.read(punched)
        write_coloured(punched, ColouredMesh(remaining, colours_at(truth, remaining.vertices)))
        harmonic, reported = (Path(folder) / f"{name}.ply" for name in ("harmonic", "auto"))
        repair_file(punched, harmonic, "smooth", RepairOptions(colours="harmonic", seed=seed))
        report = repair_file(punched, reported, "smooth", RepairOptions(seed=seed))["colours"]
        plain, ours = (score(truth, remaining, read_coloured(file)) for file in (harmonic, reported))
    figures = f"{plain[0]:.2f} / {ours[0]:.2f} | {plain[1]:.2f} / {ours[1]:.2f} | {expected(report)}"
    return f"| {path.stem} | {radius} | {n_holes} | {report['method']} | {figures} |"


def expected(report: dict[str, Any]) -> str:
    """Say what calibration holes showed: dB against harmonic colours, and the gradient energy that was kept."""
    verdict = report["calibration"]
    return "" if verdict is None else f"{verdict['gain_db']:+.2f} dB, {verdict['kept']:.2f}"


def score(truth: ColouredMesh, remaining: TriangleMesh, repaired: ColouredMesh) -> tuple[float, float]:
    """PSNR of the new vertices of a repair, in dB, and the share of the truth's gradient energy that is kept.

    Parameters
    ----------
    truth : ColouredMesh
    remaining : TriangleMesh
        What was left of it.
    repaired : ColouredMesh
        The same vertices and triangles first.
    """
    n, m = len(remaining.vertices), len(remaining.triangles)
    _, nearest = cKDTree(truth.mesh.vertices).query(repaired.mesh.vertices[n:])
    squared = float(((repaired.colours[n:] - truth.colours[nearest]) ** 2).mean())
    psnr = 10 * float(np.log10(255.0**2 / squared)) if squared else np.inf
    lost = truth.mesh.triangles[~kept_triangles(truth.mesh, remaining)]
    energies = [
        energy_per_area(truth.mesh.vertices, lost, truth.colours),
        energy_per_area(repaired.mesh.vertices, repaired.mesh.triangles[m:], repaired.colours),
    ]
    return psnr, energies[1] / energies[0] if energies[0] else np.nan


def energy_per_area(vertices: Vertices, triangles: Triangles, colours: FloatArray) -> float:
    """Mean squared gradient of linearly interpolated colours over some triangles; triangles without area don't count.

    Along a triangle with edges e and colours c of the corners across from them, the gradient times twice the area is
    the sum of c times e, turned by a right angle.
    """
    corners, tints = vertices[triangles], colours[triangles]
    doubled = np.linalg.norm(area_vectors(vertices, triangles), axis=1)
    across = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)
    turned = np.einsum("tkc,tkx->tcx", tints, across)
    proper = doubled > 1e-12 * doubled.max()
    energy = (turned[proper] ** 2).sum(axis=(1, 2)) / (2 * doubled[proper])
    return float(energy.sum() / (doubled.sum() / 2))


def kept_triangles(mesh: TriangleMesh, remaining: TriangleMesh) -> BoolArray:
    """Which triangles (n_triangles,) of a mesh are also in what remained of it."""
    number = _position(mesh.vertices, remaining.vertices)[remaining.triangles]
    n = len(mesh.vertices)
    whole, left = ((np.sort(rows, axis=1) @ np.array([n * n, n, 1])) for rows in (mesh.triangles, number))
    return np.isin(whole, left)


def colours_at(truth: ColouredMesh, vertices: Vertices) -> FloatArray:
    """Colours (k, 3) of some of the vertices."""
    return np.asarray(truth.colours[_position(truth.mesh.vertices, vertices)])


def _position(vertices: Vertices, wanted: Vertices) -> IntArray:
    return np.asarray(cKDTree(vertices).query(wanted)[1], np.int64)


def normalised(coloured: ColouredMesh) -> ColouredMesh:
    """Scale to a longest side of 1, in single precision, as the bench wants it."""
    vertices = coloured.mesh.vertices
    scaled = ((vertices - vertices.mean(axis=0)) / np.ptp(vertices, axis=0).max()).astype("f4").astype(np.float64)
    return ColouredMesh(TriangleMesh(scaled, coloured.mesh.triangles), coloured.colours)


def read_coloured(path: Path) -> ColouredMesh:
    """Read a mesh with colours of vertices; raises ValueError for one without."""
    scan = read_scan(path)
    colours = None if scan.source is None else scan.source.vertex_colours(scan)
    if colours is None:
        raise ValueError(f"{path} has no colours of vertices")
    return ColouredMesh(TriangleMesh(scan.vertices, scan.triangles), colours[:, :3])


def write_coloured(path: Path, coloured: ColouredMesh) -> None:
    """Write a binary PLY with bytes for colours."""
    mesh = coloured.mesh
    rows = np.zeros(len(mesh.vertices), [("position", "<f4", 3), ("colour", "u1", 3)])
    rows["position"], rows["colour"] = mesh.vertices, np.rint(coloured.colours)
    faces = np.zeros(len(mesh.triangles), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, mesh.triangles
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(rows)}"]
    lines += [f"property float {axis}" for axis in "xyz"]
    lines += [f"property uchar {name}" for name in ("red", "green", "blue")]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    path.write_bytes("\n".join(lines).encode() + rows.tobytes() + faces.tobytes())


if __name__ == "__main__":
    main()
