"""Texture pages of new surface beside harmonic ones, on textured meshes that holes were punched into.

    python -m benchmarks.textures BENCH [MESH ...] [--size 1024]

Measured are the pizza of the bench with its gloss map, a plate with bricks made in code, and coloured meshes that are
named: their colours are baked into an atlas, each pair of triangles a square. Images are brought to a size. Meshes are
scaled to a longest side of 1 and punched as the bench does. Two figures are printed, those of harmonic colours in
front: PSNR of the new surface, sampled once a texel, against the image at the nearest place of the truth, in dB; and
its gradient energy per area over that of what was punched out.

Tested in `tests/benchmarks/test_textures.py`.
"""

import argparse
import io
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.ndimage import gaussian_filter

from benchmarks.colours import energy_per_area, expected, kept_triangles, normalised, read_coloured
from benchmarks.quality.bench import RADII, Bench
from quadpatch.formats.reading import read_scan
from quadpatch.formats.scan import Scan
from quadpatch.formats.surface_texture import SurfaceTexture
from quadpatch.mesh.distance import project
from quadpatch.mesh.edge_splitting import split_long_edges
from quadpatch.mesh.normals import area_vectors, length
from quadpatch.options import RepairOptions
from quadpatch.repair import repair_file
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Vertices

SCAN, GLOSS = Path("colour") / "pizza.obj", Path("colour") / "gloss.jpg"
_PIXELS = NDArray[np.uint8]


@dataclass(frozen=True)
class TexturedMesh:
    """A mesh with one image: texture coordinates (m, 3, 2) of corners, v upwards, and pixels."""

    mesh: TriangleMesh
    coordinates: FloatArray
    pixels: _PIXELS

    @property
    def texel(self) -> float:
        """Mean width of a texel on the surface, in mesh units."""
        a, b, c = (self.coordinates[:, corner] for corner in range(3))
        flat = np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]).sum()
        area = length(area_vectors(self.mesh.vertices, self.mesh.triangles)).sum()
        return float(np.sqrt(area / (flat * self.pixels.shape[0] * self.pixels.shape[1])))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench", type=Path, help="folder with bench.py")
    parser.add_argument("mesh", nargs="*", type=Path, help="coloured PLY; else the pizza and bricks")
    parser.add_argument("--radius", nargs="*", default=RADII, help="of the holes, in shares of the longest side")
    parser.add_argument("--size", type=int, default=1024, help="width and height of the images")
    parser.add_argument("--seed", type=int, default=0, help="of the repairs")
    parser.add_argument("--keep", type=Path, help="folder for the repaired meshes and their images")
    arguments = parser.parse_args()
    bench = Bench.open(arguments.bench)
    truths = {path.stem: baked(path, arguments.size) for path in arguments.mesh}
    if not truths:
        truths = {"pizza": pizza(arguments.bench, arguments.size), "bricks": bricks(arguments.size)}
    print("| mesh | radius | holes | colours | PSNR, dB | gradient energy kept | expected by calibration |")  # noqa: T201
    print("| --- | ---: | ---: | --- | ---: | ---: | ---: |")  # noqa: T201
    for name, truth in truths.items():
        for radius in arguments.radius:
            with tempfile.TemporaryDirectory() as folder:
                kept = Path(folder) if arguments.keep is None else arguments.keep / f"{name}_{radius}"
                kept.mkdir(parents=True, exist_ok=True)
                print(f"| {name} | {row(bench, truth, radius, kept, arguments.seed)}", flush=True)  # noqa: T201


def row(bench: Bench, truth: TexturedMesh, radius: str, folder: Path, seed: int = 0) -> str:
    """Punch a mesh and repair it, with harmonic colours and with those that calibration chooses."""
    whole = folder / "truth.ply"
    bench.script.write_ply(whole, truth.mesh.vertices, truth.mesh.triangles)
    n_holes = len(bench.script.punch(whole, float(radius), folder)["holes"])
    remaining = bench.read(folder / "punched.ply")
    is_kept = kept_triangles(truth.mesh, remaining)
    punched = TexturedMesh(remaining, truth.coordinates[is_kept], truth.pixels)
    write_textured(folder / "scan.ply", punched)
    lost = replace(
        truth,
        mesh=TriangleMesh(truth.mesh.vertices, truth.mesh.triangles[~is_kept]),
        coordinates=truth.coordinates[~is_kept],
    )
    figures, reports = [], []
    for colours in ("harmonic", "auto"):
        options = RepairOptions(colours=colours, seed=seed)
        output = folder / f"{colours}.ply"
        reports.append(repair_file(folder / "scan.ply", output, "smooth", options)["texture"])
        figures.append(score(truth, lost, new_surface(read_scan(output), len(remaining.triangles))))
    plain, ours = figures
    table = f"{plain[0]:.2f} / {ours[0]:.2f} | {plain[1]:.2f} / {ours[1]:.2f} | {expected(reports[1])}"
    return f"{radius} | {n_holes} | {reports[1]['method']} | {table} |"


def score(truth: TexturedMesh, lost: TexturedMesh, new: TexturedMesh) -> tuple[float, float]:
    """PSNR of new surface, in dB, and the share of the gradient energy of what was lost that it keeps."""
    texel = truth.texel
    places, triangles, colours = sampled(new, texel)
    _, nearest, points = project(places, truth.mesh)
    weights = barycentric(truth.mesh, nearest, points)
    true = colours_at(truth.pixels, np.einsum("kc,kcx->kx", weights, truth.coordinates[nearest]))
    squared = float(((colours - true) ** 2).mean())
    psnr = 10 * float(np.log10(255.0**2 / squared)) if squared else np.inf
    there = sampled(lost, texel)
    energies = [energy_per_area(*there), energy_per_area(places, triangles, colours)]
    return psnr, energies[1] / energies[0] if energies[0] else np.nan


def sampled(surface: TexturedMesh, texel: float) -> tuple[Vertices, IntArray, FloatArray]:
    """Corners (k, 3) of triangles no larger than texels, these (k / 3, 3), and the colours (k, 3) of the corners."""
    split = split_long_edges(surface.mesh, texel)
    places = np.einsum("mkc,mcx->mkx", split.corners, surface.coordinates[split.parent]).reshape(-1, 2)
    corners = split.mesh.vertices[split.mesh.triangles].reshape(-1, 3)
    return corners, np.arange(len(corners)).reshape(-1, 3), colours_at(surface.pixels, places)


def barycentric(mesh: TriangleMesh, triangle: IntArray, points: Vertices) -> FloatArray:
    """Barycentric coordinates (k, 3) of points (k, 3) of triangles (k,)."""
    a, b, c = (mesh.vertices[mesh.triangles[triangle, corner]] for corner in range(3))
    parts = [np.cross(v - points, w - points) for v, w in ((b, c), (c, a), (a, b))]
    whole = sum(parts)
    weights = np.stack([np.einsum("ij,ij->i", part, whole) for part in parts], axis=1).clip(min=0)
    total = weights.sum(axis=1, keepdims=True)
    return np.asarray(np.where(total > 0, weights / np.where(total > 0, total, 1), 1 / 3))


def colours_at(pixels: _PIXELS, places: FloatArray) -> FloatArray:
    """Colours (k, 3) between the four texels around places (k, 2), v upwards."""
    height, width = pixels.shape[:2]
    x, y = places[:, 0] * width - 0.5, (1 - places[:, 1]) * height - 0.5
    column, line = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    right, down = (x - column)[:, np.newaxis], (y - line)[:, np.newaxis]
    four = [pixels[(line + i) % height, (column + j) % width].astype(np.float64) for i in (0, 1) for j in (0, 1)]
    return np.asarray(
        (1 - down) * ((1 - right) * four[0] + right * four[1]) + down * ((1 - right) * four[2] + right * four[3])
    )


def new_surface(scan: Scan, n_measured: int) -> TexturedMesh:
    """Take the new triangles of a repaired scan, and their page."""
    texture = None if scan.source is None else scan.source.surface_texture(scan)
    assert isinstance(texture, SurfaceTexture)
    page = texture.images[-1]
    assert page is not None
    pixels = np.asarray(Image.open(io.BytesIO(page.read())).convert("RGB"))
    return TexturedMesh(
        TriangleMesh(scan.vertices, scan.triangles[n_measured:]), texture.coordinates[n_measured:], pixels
    )


def pizza(bench: Path, size: int) -> TexturedMesh:
    """Read the pizza of the bench, its gloss map brought to a size."""
    scan = read_scan(bench / SCAN)
    texture = None if scan.source is None else scan.source.vertex_attributes(scan).texture
    assert texture is not None
    pixels = np.asarray(Image.open(bench / GLOSS).convert("RGB").resize((size, size), Image.Resampling.BOX))
    return TexturedMesh(_single(scan.vertices, scan.triangles), texture, pixels)


def bricks(size: int, n: int = 120) -> TexturedMesh:
    """Make a wavy plate with bricks of different colours, 64 by 32 texels."""
    x, y = (axis.ravel() for axis in np.meshgrid(*[np.linspace(0, 1, n)] * 2, indexing="xy"))
    height = 0.02 * np.sin(9 * x) * np.cos(7 * y)
    corner = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    mesh = _single(np.stack([x, y, height], axis=1), triangles)
    return TexturedMesh(mesh, np.stack([x, y], axis=1)[triangles], brick_pixels(size))


def brick_pixels(size: int) -> _PIXELS:
    """Make an image of bricks with joints and grain."""
    rng = np.random.default_rng(0)
    y, x = np.mgrid[:size, :size]
    course = y // 32
    along = x + 32 * (course % 2)
    is_joint = (y % 32 < 4) | (along % 64 < 4)
    grain = gaussian_filter(rng.normal(size=(size, size)), 1.5)
    tint = rng.normal(size=(size // 32 + 1, size // 64 + 2))[course, along // 64]
    brick = np.array([150, 70, 50]) + 15 * tint[..., np.newaxis]
    colours = np.where(is_joint[..., np.newaxis], np.array([200, 195, 190]), brick)
    return np.asarray(np.clip(colours + 12 * (grain / grain.std())[..., np.newaxis], 0, 255).astype(np.uint8))


def baked(path: Path, size: int) -> TexturedMesh:
    """Bake the colours of vertices into an atlas in which two triangles each share a square."""
    coloured = normalised(read_coloured(path))
    m = len(coloured.mesh.triangles)
    per_side = int(np.ceil(np.sqrt((m + 1) // 2)))
    cell = max(size // per_side, 6)
    number = np.arange(m)
    corner = np.stack([number // 2 % per_side, number // 2 // per_side], axis=1) * cell
    # Half a texel inside the square, and as much between the two.
    lower = np.array([[1.0, 1.0], [cell - 2.5, 1.0], [1.0, cell - 2.5]])
    corners = np.where((number % 2 == 0)[:, np.newaxis, np.newaxis], lower, cell - lower) + corner[:, np.newaxis]
    width = per_side * cell
    pixels = np.zeros((width, width, 3), np.uint8)
    y, x = np.mgrid[:cell, :cell] + 0.5
    for half in (0, 1):
        shape = lower if half == 0 else cell - lower
        weights = np.linalg.solve(
            np.concatenate([shape.T, np.ones((1, 3))]), np.stack([x.ravel(), y.ravel(), np.ones(x.size)])
        )
        mine = ((x + y <= cell) if half == 0 else (x + y > cell)).ravel()
        tints = coloured.colours[coloured.mesh.triangles[half::2]]
        shown = np.einsum("cp,tcx->tpx", weights.clip(0, 1) / weights.clip(0, 1).sum(axis=0), tints)[:, mine]
        at = corner[half::2]
        rows = at[:, 1, np.newaxis] + (np.mgrid[:cell, :cell][0].ravel()[mine])
        columns = at[:, 0, np.newaxis] + (np.mgrid[:cell, :cell][1].ravel()[mine])
        pixels[rows, columns] = np.rint(shown)
    coordinates = corners / width * [1.0, -1.0] + [0.0, 1.0]
    return TexturedMesh(coloured.mesh, coordinates, pixels)


def _single(vertices: Vertices, triangles: IntArray) -> TriangleMesh:
    """Scale to a longest side of 1, in single precision, as the bench wants it."""
    scaled = (vertices - vertices.mean(axis=0)) / np.ptp(vertices, axis=0).max()
    return TriangleMesh(scaled.astype("f4").astype(np.float64), triangles)


def write_textured(path: Path, textured: TexturedMesh) -> None:
    """Write a binary PLY with texture coordinates of corners, and its image beside it."""
    Image.fromarray(textured.pixels).save(path.with_suffix(".png"), compress_level=1)
    mesh = textured.mesh
    fields: list[Any] = [("n", "u1"), ("corners", "<i4", 3), ("m", "u1"), ("wedges", "<f8", 6)]
    rows = np.zeros(len(mesh.triangles), fields)
    rows["n"], rows["corners"], rows["m"], rows["wedges"] = 3, mesh.triangles, 6, textured.coordinates.reshape(-1, 6)
    lines = ["ply", "format binary_little_endian 1.0", f"comment TextureFile {path.stem}.png"]
    lines += [f"element vertex {len(mesh.vertices)}", *[f"property float {axis}" for axis in "xyz"]]
    lines += [f"element face {len(rows)}", "property list uchar int vertex_indices"]
    lines += ["property list uchar double texcoord", "end_header", ""]
    path.write_bytes("\n".join(lines).encode() + mesh.vertices.astype("<f4").tobytes() + rows.tobytes())


if __name__ == "__main__":
    main()
