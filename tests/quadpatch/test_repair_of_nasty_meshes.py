import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.errors import EmptyMeshError
from quadpatch.formats.reading import read_scan
from quadpatch.options import HoleOptions, RepairOptions
from quadpatch.repair import inspect_file, repair_file
from quadpatch.types import FloatArray, TriangleMesh, Triangles
from tests.quadpatch.shapes import (
    bumpy_plate,
    faces_per_edge,
    has_a_face,
    joined,
    open_grid,
    punched,
    sphere,
    write_ply,
)

EVERYTHING = RepairOptions(HoleOptions(max_diameter=1e30))
ONE: Triangles = np.array([[0, 1, 2]])


def plate_with(*faces: tuple[int, int, int]) -> TriangleMesh:
    mesh = punched(bumpy_plate(24, 2.0), (0.2, 0.1, 0), radius=0.25)
    return TriangleMesh(mesh.vertices, np.concatenate([mesh.triangles, np.array(faces, np.int64).reshape(-1, 3)]))


def strip(n: int) -> TriangleMesh:
    """A Möbius strip."""
    angle = 2 * np.pi * np.arange(n) / n
    across = np.stack([np.cos(angle / 2) * np.cos(angle), np.cos(angle / 2) * np.sin(angle), np.sin(angle / 2)], 1)
    middle = np.stack([np.cos(angle), np.sin(angle), 0 * angle], 1)
    vertices = np.stack([middle - 0.3 * across, middle + 0.3 * across], axis=1).reshape(-1, 3)
    rows = [(2 * i, 2 * i + 1, 2 * i + 2) for i in range(n - 1)]
    rows += [(2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(n - 1)]
    return TriangleMesh(vertices, np.array([*rows, (2 * n - 2, 2 * n - 1, 1), (2 * n - 1, 0, 1)]))


def slit() -> TriangleMesh:
    mesh = punched(open_grid(24), (0.5, 0.5, 0), radius=2.5)
    vertices = mesh.vertices.copy()
    inner = np.linalg.norm(vertices - [0.5, 0.5, 0], axis=1) < 4
    vertices[inner, 1] = 0.5
    return TriangleMesh(vertices, mesh.triangles)


def lonely() -> TriangleMesh:
    mesh = plate_with()
    return TriangleMesh(np.concatenate([mesh.vertices, [[50.0, 0, 0], [0, 0, 50]]]), mesh.triangles)


def crumbs() -> TriangleMesh:
    """A sheet with a hole, a closed ball, a loose triangle, and a speck whose areas vanish in float64."""
    speck = TriangleMesh(1e-170 * open_grid(5).vertices, punched(open_grid(5), (0, 0, 0), radius=0.5).triangles)
    flat = TriangleMesh(open_grid(2).vertices + np.array([0, 0, 3]), open_grid(2).triangles[:1])
    return joined(plate_with(), sphere(2, 0.1), flat, speck)


def triangle(*corners: tuple[float, float, float]) -> TriangleMesh:
    return TriangleMesh(np.array(corners, np.float64), ONE)


NASTY: dict[str, Callable[[], TriangleMesh]] = {
    "a single triangle": lambda: triangle((0, 0, 0), (1, 0, 0), (0, 1, 0)),
    "a triangle without area": lambda: triangle((0, 0, 0), (1, 0, 0), (2, 0, 0)),
    "lonely vertices": lonely,
    "a face twice": lambda: plate_with((0, 1, 25)),
    "a face and its back": lambda: plate_with((1, 0, 25)),
    "faces without area": lambda: plate_with((0, 0, 1), (5, 5, 5), (0, 1, 2)),
    "a fin": lambda: plate_with((100, 101, 500)),
    "crumbs": crumbs,
    "a Möbius strip": lambda: strip(30),
    "a slit": slit,
    "far away": lambda: TriangleMesh(plate_with().vertices + 1e9, plate_with().triangles),
    "far away, rounded to a step of its edges": lambda: TriangleMesh(
        plate_with().vertices + 1e15, plate_with().triangles
    ),
    "huge": lambda: TriangleMesh(plate_with().vertices * 1e17, plate_with().triangles),
    "tiny": lambda: TriangleMesh(plate_with().vertices * 1e-36, plate_with().triangles),
}

# A border and one hole, where nothing else is said.
VERDICTS: dict[str, list[str]] = {
    "a single triangle": ["skipped"],
    "a triangle without area": ["filled_smooth"],
    "crumbs": ["skipped", "skipped", "refused", "refused", "filled_smooth"],
    "a Möbius strip": ["skipped", "skipped"],
    "a slit": ["skipped"],
}
# Rounded to steps as long as its edges, its hole is wider than what the default fills.
TOO_WIDE = "far away, rounded to a step of its edges"


@pytest.mark.parametrize("model", ["smooth", "self"])
@pytest.mark.parametrize("name", NASTY)
def test_every_loop_of_a_nasty_mesh_gets_its_verdict(tmp_path: Path, name: str, model: str) -> None:
    mesh = NASTY[name]()
    source, output = write_ply(tmp_path / "in.ply", mesh), tmp_path / "out.ply"
    for options in (RepairOptions(), EVERYTHING):
        report = repair_file(source, output, model, options)
        is_left_out = name == TOO_WIDE and options is not EVERYTHING
        verdicts = ["skipped", "skipped"] if is_left_out else VERDICTS.get(name, ["skipped", "filled_smooth"])
        assert [hole["verdict"] for hole in report["holes"]] == verdicts
        check(mesh, output, report)


def check(mesh: TriangleMesh, output: Path, report: dict[str, Any]) -> None:
    json.dumps(report, allow_nan=False)
    after = read_scan(output)
    assert np.isfinite(after.vertices).all()
    assert after.vertices[: len(mesh.vertices)].tobytes() == mesh.vertices.tobytes()
    assert (after.triangles[: len(mesh.triangles)] == mesh.triangles).all()
    assert crowded(after.triangles) == crowded(mesh.triangles)


def crowded(triangles: Triangles) -> int:
    """Edges of three and more faces, exact copies of faces aside."""
    return int((faces_per_edge(np.unique(np.sort(triangles, axis=1), axis=0)) > 2).sum())


@pytest.mark.parametrize(
    "vertices",
    [
        np.zeros((3, 3)),
        np.array([[0.0, 0, 0], [0, 0, 0], [1, 0, 0]]),
        np.array([[0.0, 0, 0], [1, 0, 0], [1, 0, 0]]),
    ],
)
def test_meshes_without_a_surface_are_refused(tmp_path: Path, vertices: FloatArray) -> None:
    source = write_ply(tmp_path / "in.ply", TriangleMesh(vertices, ONE))
    with pytest.raises(EmptyMeshError):
        repair_file(source, tmp_path / "out.ply", "smooth")
    with pytest.raises(EmptyMeshError):
        inspect_file(source)


@given(seed=st.integers(0, 2**32 - 1), n=st.integers(3, 40), m=st.integers(1, 80), lattice=st.booleans())
@settings(max_examples=25)
def test_heaps_of_random_triangles_are_repaired_unless_no_face_has_three_corners(
    tmp_path_factory: pytest.TempPathFactory, seed: int, n: int, m: int, lattice: bool
) -> None:
    rng = np.random.default_rng(seed)
    vertices = rng.integers(0, 3, (n, 3)).astype(np.float64) if lattice else rng.normal(size=(n, 3))
    mesh = TriangleMesh(vertices, rng.integers(0, n, (m, 3)))
    folder = tmp_path_factory.mktemp("heap")
    source = write_ply(folder / "in.ply", mesh)
    for model in ("smooth", "self"):
        if not has_a_face(mesh):
            with pytest.raises(EmptyMeshError):
                repair_file(source, folder / "out.ply", model, EVERYTHING)
            continue
        report = repair_file(source, folder / "out.ply", model, EVERYTHING)
        json.dumps(report, allow_nan=False)
        after = read_scan(folder / "out.ply")
        assert np.isfinite(after.vertices).all()
        assert after.vertices[:n].tobytes() == vertices.tobytes()
