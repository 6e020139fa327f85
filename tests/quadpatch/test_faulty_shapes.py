"""Faults of real scans, one at a time: each is repaired without a fold or a crossing triangle, or left with a code."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.surface_faults import SurfaceFaults, find_faults_in_files
from quadpatch.options import HoleOptions, RepairOptions
from quadpatch.repair import inspect_file, repair_file
from quadpatch.types import TriangleMesh
from tests.quadpatch.faulty_shapes import (
    inner_loop,
    sheet_with_crack,
    sheet_with_round_hole,
    sheet_with_spiral,
    with_flap,
    with_island,
    with_split_rim_edge,
    with_triangle_at_rim,
)
from tests.quadpatch.shapes import is_oriented_manifold, open_grid, punched, sphere, write_ply

LONG_RIMS = {
    "round hole in a plane": (sheet_with_round_hole(33.0), 220),
    "round hole in a sphere": (sheet_with_round_hole(33.0, bend=60.0), 220),
    "crack": (sheet_with_crack(140), 300),
    "square spiral": (sheet_with_spiral(), 300),
}
BALL = punched(sphere(4), (0, 0, 1), radius=0.3)
PLATE = punched(open_grid(40), (0.5, 0.5, 0), radius=4.0)


def repaired(folder: Path, mesh: TriangleMesh, hole: int | None = None) -> tuple[dict[str, Any], SurfaceFaults]:
    """Repair a mesh through files, of all holes or of one; the report, and what the judge says."""
    before, after = write_ply(folder / "in.ply", mesh), folder / "out.ply"
    options = RepairOptions() if hole is None else RepairOptions(HoleOptions(ids=(hole,)))
    report = repair_file(before, after, "smooth", options)
    return report, find_faults_in_files(before, after)


def hole_of(folder: Path, mesh: TriangleMesh) -> int:
    """The id of the loop that is the hole of a sheet: not the widest one."""
    holes = inspect_file(write_ply(folder / "in.ply", mesh))["holes"]
    return int(min(holes, key=lambda hole: hole["diameter"])["id"])


def assert_sound(faults: SurfaceFaults) -> None:
    assert faults.is_kept
    assert (faults.n_folds, faults.n_crossings, faults.n_doubled, faults.n_nonmanifold) == (0, 0, 0, 0)


@pytest.mark.parametrize("name", LONG_RIMS)
def test_the_long_rims_are_long_and_their_meshes_sound(name: str) -> None:
    mesh, n_edges = LONG_RIMS[name]
    assert is_oriented_manifold(mesh.triangles)
    assert len(inner_loop(mesh)) >= n_edges


@pytest.mark.parametrize("name", LONG_RIMS)
def test_a_long_rim_is_filled_without_a_fold(name: str, tmp_path: Path) -> None:
    mesh, _ = LONG_RIMS[name]
    report, faults = repaired(tmp_path, mesh, hole_of(tmp_path, mesh))
    assert report["counts"]["filled_smooth"] == 1
    assert_sound(faults)


@pytest.mark.parametrize("height", [1e-2, 1e-8, 0.0])
@pytest.mark.parametrize("along", [0.5, 0.1])
def test_slivers_glued_to_a_rim_do_not_crumple_the_fill(along: float, height: float, tmp_path: Path) -> None:
    mesh = BALL
    for edge in (1, 6, 11):
        mesh = with_triangle_at_rim(mesh, edge, along, height)
    report, faults = repaired(tmp_path, mesh)
    assert report["counts"]["filled_smooth"] == 1
    assert_sound(faults)


@pytest.mark.parametrize("along", [1e-2, 1e-4, 1e-8, 1e-12])
def test_needles_across_a_rim_do_not_crumple_the_fill(along: float, tmp_path: Path) -> None:
    mesh = BALL
    for edge in (1, 6, 11):
        mesh = with_split_rim_edge(mesh, edge, along)
    report, faults = repaired(tmp_path, mesh)
    assert report["counts"]["filled_smooth"] == 1
    assert_sound(faults)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize(("around", "rise"), [(BALL, 0.15), (BALL, 0.5), (PLATE, 0.0)], ids=["in", "above", "flat"])
def test_no_fill_runs_through_an_island_in_its_hole(
    around: TriangleMesh, rise: float, turned: bool, tmp_path: Path
) -> None:
    mesh = with_island(around, inner_loop(around), 0.5, rise, turned=turned)
    report, faults = repaired(tmp_path, mesh)
    assert_sound(faults)
    rim = max((hole for hole in report["holes"] if hole["code"] != "border"), key=lambda hole: hole["diameter"])
    assert rim["verdict"] == "filled_smooth" or rim["code"] == "crosses_surface"


@pytest.mark.parametrize(("reach", "rise"), [(0.7, 0.0), (0.7, 0.05), (0.4, 0.6), (-0.3, 0.1)])
def test_no_fill_runs_through_a_flap_at_its_rim(reach: float, rise: float, tmp_path: Path) -> None:
    mesh = with_flap(BALL, inner_loop(BALL), reach, rise)
    assert is_oriented_manifold(mesh.triangles)
    report, faults = repaired(tmp_path, mesh)
    assert_sound(faults)
    assert {hole["verdict"] for hole in report["holes"]} <= {"filled_smooth", "refused"}


def test_a_strip_of_surface_through_a_hole_is_not_run_through(tmp_path: Path) -> None:
    """A loose sheet stands upright in the hole: there is no fill without a crossing but one beside it."""
    middle = BALL.vertices[inner_loop(BALL)].mean(axis=0)
    blade = middle + np.array([[-0.1, 0, -0.1], [0.1, 0, -0.1], [0.1, 0, 0.2], [-0.1, 0, 0.2]])
    n = len(BALL.vertices)
    faces = np.array([[n, n + 1, n + 2], [n, n + 2, n + 3]])
    mesh = TriangleMesh(np.concatenate([BALL.vertices, blade]), np.concatenate([BALL.triangles, faces]))
    report, faults = repaired(tmp_path, mesh)
    assert_sound(faults)
    rim = max(report["holes"], key=lambda hole: hole["diameter"])
    assert rim["verdict"] == "filled_smooth" or rim["code"] == "crosses_surface"
