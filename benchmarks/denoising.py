"""Denoising beside Taubin smoothing, bilateral and guided normals, on clean meshes with synthetic noise.

    python -m benchmarks.denoising BENCH

Noise is Gaussian, along the normals of the clean mesh, its standard deviation a share of the mean edge. Two errors are
printed for each method: the mean angle between the normals of its triangles and of the clean ones, in degrees, and the
mean distance of its vertices from the clean surface, in 1e-4 of the diagonal. The last meshes are cut in two: one half
is denoised, the other is the clean reference.

Tested in `tests/benchmarks/test_denoising_peers.py`.
"""

import argparse
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.denoising_peers import (
    NORMAL_ITERATIONS,
    SIGMA_NORMAL,
    Method,
    bilateral_normals,
    guided_normals,
    taubin,
)
from quadpatch.denoising.denoise import PatchModel, denoise
from quadpatch.formats.reading import read_scan
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.measures import diagonal, mean_edge_length
from quadpatch.mesh.normals import triangle_normals, vertex_normals
from quadpatch.mesh.weld import weld
from quadpatch.types import BoolArray, TriangleMesh, Vertices

MESHES = ("fandisk", "stanford_bunny")
CUT_MESHES = ("relief_gyroid",)
NOISES = (0.1, 0.2, 0.3)
SEED = 0

NORMAL_FILTERS = (bilateral_normals, guided_normals)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench", type=Path, help="folder with meshes/NAME.ply")
    parser.add_argument("--mesh", nargs="*", default=MESHES, help="denoised as a whole")
    parser.add_argument("--cut", nargs="*", default=CUT_MESHES, help="cut in two")
    parser.add_argument("--noise", nargs="*", type=float, default=NOISES, help="in mean edges")
    parser.add_argument("--width", type=float, default=SIGMA_NORMAL, help="of the peers' normal weight")
    parser.add_argument("--iterations", type=int, default=NORMAL_ITERATIONS, help="of the peers' normal filters")
    arguments = parser.parse_args()
    peers = Peers(arguments.width, arguments.iterations)
    print("| mesh | noise, edges | noisy | Taubin | bilateral | guided | ours | ours, with reference |")  # noqa: T201
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")  # noqa: T201
    for name in (*arguments.mesh, *arguments.cut):
        clean = read_mesh(arguments.bench / "meshes" / f"{name}.ply")
        reference = None
        if name in arguments.cut:
            reference, clean = halves(clean)
        for noise in arguments.noise:
            print(row(name if reference is None else f"{name}, half", clean, reference, noise, peers), flush=True)  # noqa: T201


@dataclass(frozen=True)
class Peers:
    """Settings of the two normal filters."""

    width: float = SIGMA_NORMAL
    iterations: int = NORMAL_ITERATIONS

    def methods(self) -> list[Method]:
        """Bilateral and guided normals with these settings."""
        return [partial(peer, sigma_normal=self.width, iterations=self.iterations) for peer in NORMAL_FILTERS]


def row(name: str, clean: TriangleMesh, reference: TriangleMesh | None, noise: float, peers: Peers) -> str:
    """Measure all methods on one mesh with one noise, in mean edges."""
    noisy = with_noise(clean, noise, np.random.default_rng(SEED))
    methods: list[Method | None] = [lambda mesh: mesh.vertices, taubin, *peers.methods()]
    methods.append(lambda mesh: denoise(mesh).vertices)
    model = PatchModel("reference", reference)
    methods.append(None if reference is None else lambda mesh: denoise(mesh, model=model).vertices)
    cells = ["" if method is None else "{:.2f} / {:.2f}".format(*errors(clean, method(noisy))) for method in methods]
    return f"| {name} | {noise:g} | {' | '.join(cells)} |"


def read_mesh(path: Path) -> TriangleMesh:
    """Read a mesh with its vertices joined."""
    scan = read_scan(path)
    return weld(scan.vertices, scan.triangles).mesh


def with_noise(mesh: TriangleMesh, noise: float, rng: np.random.Generator) -> TriangleMesh:
    """Move vertices along their normals by Gaussian noise, its standard deviation in mean edges."""
    size = noise * mean_edge_length(mesh) * rng.normal(size=(len(mesh.vertices), 1))
    return TriangleMesh(mesh.vertices + size * vertex_normals(mesh.vertices, mesh.triangles), mesh.triangles)


def errors(clean: TriangleMesh, vertices: Vertices) -> tuple[float, float]:
    """Mean error of the normals in degrees, and mean distance in 1e-4 of the diagonal."""
    truth = triangle_normals(clean.vertices, clean.triangles)
    cosines = np.einsum("ij,ij->i", truth, triangle_normals(vertices, clean.triangles))
    angles = np.degrees(np.arccos(np.clip(cosines, -1, 1)))[np.abs(truth).any(axis=1)]
    return float(angles.mean()), float(distance_to_mesh(vertices, clean).mean()) / diagonal(clean) * 1e4


def halves(mesh: TriangleMesh) -> tuple[TriangleMesh, TriangleMesh]:
    """Cut a mesh in two between triangles, across its longest side."""
    centres = mesh.vertices[mesh.triangles].mean(axis=1)
    along = centres[:, np.argmax(np.ptp(centres, axis=0))]
    is_first = along < np.median(along)
    return _part(mesh, is_first), _part(mesh, ~is_first)


def _part(mesh: TriangleMesh, chosen: BoolArray) -> TriangleMesh:
    used, local = np.unique(mesh.triangles[chosen], return_inverse=True)
    return TriangleMesh(mesh.vertices[used], local.reshape(-1, 3).astype(np.int64))


if __name__ == "__main__":
    main()
