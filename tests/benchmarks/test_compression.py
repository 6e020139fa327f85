import numpy as np
import pytest

pytest.importorskip("DracoPy", reason="DracoPy is in the extra bench")

from benchmarks.compression import bytes_at, vertex_psnr
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import open_grid


def test_bytes_between_two_files_are_interpolated_and_dominated_files_do_not_count() -> None:
    files = np.array([[60.0, 1000.0], [70.0, 4000.0], [59.0, 3000.0]])
    assert bytes_at(files, 65.0) == pytest.approx(2000.0)


def test_beyond_the_best_file_there_is_no_answer() -> None:
    assert bytes_at(np.array([[60.0, 1000.0], [70.0, 4000.0]]), 71.0) is None


def test_a_surface_that_is_a_thousandth_of_the_diagonal_away_has_60_decibels() -> None:
    mesh = open_grid(5)
    length = float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))
    lifted = TriangleMesh(mesh.vertices + np.array([0.0, 0.0, length / 1000]), mesh.triangles)
    assert vertex_psnr(mesh, lifted) == pytest.approx(60.0)
