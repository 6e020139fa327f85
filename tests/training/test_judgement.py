from pathlib import Path

import numpy as np
import pytest

from quadpatch.model_choice import SMOOTH
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, open_grid
from training.corpus import read_mesh
from training.judgement import MOST_HOLES, cut_known_holes, repair_error


def test_holes_of_the_benchmarks_size_are_cut_and_the_rest_is_kept(tmp_path: Path) -> None:
    mesh = bumpy_plate(200, 1.0)
    holes = cut_known_holes(mesh, tmp_path / "punched.ply", np.random.default_rng(0))
    assert holes is not None
    assert holes.radius == pytest.approx(0.025, rel=0.05)
    assert 1 < len(holes.centres) <= MOST_HOLES
    punched = read_mesh(holes.punched)
    assert len(punched.vertices) + len(holes.removed) <= len(mesh.vertices)
    kept = {tuple(vertex) for vertex in punched.vertices.tolist()}
    assert kept <= {tuple(vertex) for vertex in mesh.vertices.tolist()}
    assert not kept & {tuple(vertex) for vertex in holes.removed.tolist()}


def test_a_plane_is_repaired_without_error(tmp_path: Path) -> None:
    holes = cut_known_holes(open_grid(40), tmp_path / "punched.ply", np.random.default_rng(0))
    assert holes is not None
    assert repair_error(holes, SMOOTH, 0) < 1e-9


def test_the_error_is_that_of_what_was_inserted(tmp_path: Path) -> None:
    """A tall spike in the middle of a hole is missed by the plain fill, by about its volume."""
    flat = open_grid(40)
    holes = cut_known_holes(flat, tmp_path / "punched.ply", np.random.default_rng(0))
    assert holes is not None
    lifted = flat.vertices.copy()
    removed = (flat.vertices[:, None, :] == holes.removed).all(axis=2).any(axis=1)
    lifted[removed, 2] += 1.0
    raised = TriangleMesh(lifted, flat.triangles)
    truth = type(holes)(raised, holes.punched, holes.centres, holes.radius, lifted[removed])
    assert 0.4 < repair_error(truth, SMOOTH, 0) < 1.0


def test_a_mesh_without_room_has_no_known_holes(tmp_path: Path) -> None:
    punched = tmp_path / "punched.ply"
    assert cut_known_holes(open_grid(5), punched, np.random.default_rng(0)) is None
    assert not punched.exists()
