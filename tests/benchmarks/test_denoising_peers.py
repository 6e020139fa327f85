"""Tests of `benchmarks/denoising.py` and `benchmarks/denoising_peers.py`."""

import numpy as np
import pytest

from benchmarks.denoising import Peers, errors, halves, row, with_noise
from benchmarks.denoising_peers import Method, bilateral_normals, guided_normals, taubin
from tests.quadpatch.denoising.noisy_shapes import roof
from tests.quadpatch.shapes import relief, sphere


@pytest.mark.parametrize("peer", [bilateral_normals, guided_normals, taubin])
def test_peers_take_noise_off_a_sphere(peer: Method) -> None:
    clean = sphere(3)
    noisy = with_noise(clean, 0.2, np.random.default_rng(0))
    angle, distance = errors(clean, peer(noisy))
    noisy_angle, noisy_distance = errors(clean, noisy.vertices)
    assert angle < 0.5 * noisy_angle
    assert distance < 0.7 * noisy_distance


def test_filtered_normals_keep_a_crease_better_than_taubin_smoothing() -> None:
    clean = roof(30)
    noisy = with_noise(clean, 0.2, np.random.default_rng(0))
    rounded = errors(clean, taubin(noisy))[0]
    assert errors(clean, bilateral_normals(noisy))[0] < 0.6 * rounded
    assert errors(clean, guided_normals(noisy))[0] < 0.6 * rounded


def test_the_clean_mesh_has_no_error() -> None:
    clean = relief(10)
    assert errors(clean, clean.vertices) == pytest.approx((0.0, 0.0), abs=1e-4)


def test_halves_hold_all_triangles() -> None:
    clean = relief(11)
    assert sum(len(half.triangles) for half in halves(clean)) == len(clean.triangles)


def test_a_row_has_a_cell_for_each_method() -> None:
    reference, clean = halves(relief(40))
    assert row("relief", clean, reference, 0.2, Peers()).count(" / ") == 6
    assert row("relief", clean, None, 0.2, Peers()).count(" / ") == 5
