"""``python -m benchmarks.bridges [MESH...]``: bridges over gaps where it is known what was there.

A band is taken out of a sphere and a torus, whose surface is known exactly, and out of the middle of each mesh that is
named, across its longest side. The loops that are proposed are joined, or the two widest where none are, and the new
vertices compared with the surface that was there. Errors are shares of the gap; beside them stand those of the plain
triangulation of the strip, refined and left at that.
"""

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import trimesh.creation
from rich.console import Console

from benchmarks.quality.tables import NOTHING, Table
from quadpatch.filling.bridge_proposals import propose_bridges
from quadpatch.filling.bridged_rims import join_bridges
from quadpatch.filling.bridges import make_bridges, ribs_of
from quadpatch.filling.fill import close_flat
from quadpatch.filling.islands import JoinedRims
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.holes import find_holes
from quadpatch.mesh.measures import diagonal
from quadpatch.options import HoleOptions, RepairOptions
from quadpatch.recipes.default import inpaint
from quadpatch.repair import read_surface
from quadpatch.types import BoolArray, FloatArray, TriangleMesh, Vertices

# Widths of the gaps: shares of the radius of the sphere and of the tube of the torus, and of the diagonal of a mesh.
GAPS = (0.1, 0.25, 0.5, 1.0)
GAPS_OF_MESHES = (0.02, 0.05)
COLUMNS = ("surface", "gap", "proposed", "joined", "mean error", "largest", "plain strip", "expected error")
# Radius of the torus, whose tube has radius 1 as the sphere has.
_RADIUS = 3.0

# Distance of points (n, 3) to the true surface: (n,).
Distance = Callable[[Vertices], FloatArray]


@dataclass(frozen=True)
class Case:
    """A mesh with a gap."""

    name: str
    mesh: TriangleMesh
    gap: float
    distance: Distance


@dataclass(frozen=True)
class Outcome:
    """What came of it; errors and the expected error as shares of the gap, None where nothing was joined."""

    n_proposed: int
    n_joined: int
    mean: float | None = None
    largest: float | None = None
    plain: float | None = None
    expected: float | None = None


def smooth_cases() -> Iterator[Case]:
    """Build a sphere and a torus with gaps of all widths."""
    ball = trimesh.creation.icosphere(5)
    ring = trimesh.creation.torus(_RADIUS, 1.0, major_sections=180, minor_sections=60)
    for gap in GAPS:
        mesh = _mesh_of(ball)
        yield Case("sphere", _without(mesh, np.abs(mesh.vertices[:, 2] - 0.1) < gap / 2), gap, _to_sphere)
        mesh = _mesh_of(ring)
        angle = np.arctan2(mesh.vertices[:, 1], mesh.vertices[:, 0])
        is_gone = np.abs(angle) < gap / (2 * _RADIUS)
        yield Case("torus", _without(mesh, is_gone), gap, _to_torus)


def mesh_cases(path: Path) -> Iterator[Case]:
    """Take bands out of the middle of a mesh."""
    mesh = read_surface(path)[1].mesh
    axis = int(np.ptp(mesh.vertices, axis=0).argmax())
    along = mesh.vertices[:, axis]
    middle = (along.min() + along.max()) / 2
    for share in GAPS_OF_MESHES:
        gap = share * diagonal(mesh)
        cut = _without(mesh, np.abs(along - middle) < gap / 2)
        yield Case(path.stem, cut, gap, partial(distance_to_mesh, mesh=mesh))


def measure(case: Case) -> Outcome:
    """Join the loops of a case, and compare the strips with the truth."""
    holes = find_holes(case.mesh)
    proposed = [proposal.holes for proposal in propose_bridges(case.mesh, holes, {})]
    pairs = tuple(proposed or [(0, 1)])
    repair = inpaint(case.mesh, None, RepairOptions(HoleOptions(ids=(), bridges=pairs)))
    filled = repair.filled
    joined = [repair.results[first] for first, _ in pairs if repair.results[first].verdict.startswith("filled")]
    if not joined:
        return Outcome(len(proposed), 0)
    bridges, _ = make_bridges(case.mesh, holes, list(pairs))
    surface = ribs_of(bridges).added_to(case.mesh)
    plain = close_flat(surface, join_bridges(surface, holes, JoinedRims([], [], {}), bridges, {}).loops)
    errors, flat = (case.distance(one.mesh.vertices[one.n_measured_vertices :]) / case.gap for one in (filled, plain))
    expected = np.mean([result.expected_error or 0.0 for result in joined]) / case.gap
    return Outcome(
        len(proposed), len(joined), float(errors.mean()), float(errors.max()), float(flat.mean()), float(expected)
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure all cases and print a table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.bridges", description=__doc__)
    parser.add_argument("meshes", nargs="*", type=Path, metavar="MESH")
    given = parser.parse_args(arguments)
    cases = [*smooth_cases(), *(case for path in given.meshes for case in mesh_cases(path))]
    table = Table("Errors as shares of the gap", COLUMNS, [_row(case, measure(case)) for case in cases])
    Console(width=120).print(table.to_rich())
    return 0


def _row(case: Case, found: Outcome) -> list[str]:
    numbers = (found.mean, found.largest, found.plain, found.expected)
    cells = [NOTHING if number is None else f"{number:.5f}" for number in numbers]
    return [case.name, f"{case.gap:.3g}", str(found.n_proposed), str(found.n_joined), *cells]


def _mesh_of(mesh: trimesh.Trimesh) -> TriangleMesh:
    return TriangleMesh(np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int64))


def _without(mesh: TriangleMesh, is_gone: BoolArray) -> TriangleMesh:
    """Take out the triangles with a corner among some vertices."""
    return TriangleMesh(mesh.vertices, mesh.triangles[~is_gone[mesh.triangles].any(axis=1)])


def _to_sphere(points: Vertices) -> FloatArray:
    return np.asarray(np.abs(np.linalg.norm(points, axis=1) - 1))


def _to_torus(points: Vertices) -> FloatArray:
    return np.asarray(np.abs(np.hypot(np.hypot(points[:, 0], points[:, 1]) - _RADIUS, points[:, 2]) - 1))


if __name__ == "__main__":
    sys.exit(main())
