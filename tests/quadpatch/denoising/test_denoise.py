from typing import Any

import numpy as np
import pytest

from quadpatch.denoising.denoise import PatchModel, denoise
from quadpatch.denoising.options import Box, DenoiseOptions
from quadpatch.errors import OptionError
from quadpatch.inpainters.model_file import load_model, shipped_model
from quadpatch.types import TriangleMesh
from tests.quadpatch.denoising.noisy_shapes import SHAPES, normal_error, roof, with_noise
from tests.quadpatch.shapes import joined, moved, open_grid, relief, sphere


@pytest.mark.parametrize("shape", ["sphere", "cylinder", "roof"])
def test_most_of_the_noise_goes(shape: str) -> None:
    clean = SHAPES[shape]()
    noisy, noise = with_noise(clean, 0.2)
    denoised = denoise(noisy)
    assert denoised.noise == pytest.approx(noise, rel=0.15)
    assert normal_error(clean, denoised.vertices) < 0.45 * normal_error(clean, noisy.vertices)
    assert np.allclose(denoised.shift, np.linalg.norm(denoised.vertices - noisy.vertices, axis=1))
    assert sum(denoised.shares.values()) == pytest.approx(1.0)


def test_a_clean_reference_helps_on_a_relief() -> None:
    clean, reference = relief(60, waves=8), relief(80, width=2.0 * 80 / 60, waves=11)
    noisy, noise = with_noise(clean, 0.3)
    options = DenoiseOptions(noise=noise)
    by_reference = denoise(noisy, options, PatchModel("reference", reference))
    without = denoise(noisy, options, PatchModel("none"))
    assert normal_error(clean, by_reference.vertices) < 0.85 * normal_error(clean, without.vertices)


def test_a_shipped_dictionary_does_no_harm() -> None:
    clean = relief(40)
    noisy, _ = with_noise(clean, 0.2)
    model = PatchModel("dictionary", dictionary=load_model(shipped_model("general-dictionary")).dictionary)
    by_dictionary, without = denoise(noisy, model=model), denoise(noisy, model=PatchModel("none"))
    assert by_dictionary.n_patches > 0
    assert normal_error(clean, by_dictionary.vertices) < 1.05 * normal_error(clean, without.vertices)


@pytest.mark.parametrize("max_shift", [1e-6, 0.01, None])
def test_no_vertex_moves_farther_than_the_bound(max_shift: float | None) -> None:
    noisy, _ = with_noise(sphere(3), 0.3)
    denoised = denoise(noisy, DenoiseOptions(max_shift=max_shift))
    assert np.linalg.norm(denoised.vertices - noisy.vertices, axis=1).max() <= denoised.max_shift
    assert (denoised.at_bound.sum() > 100) == (max_shift is not None)
    # In a file of 32-bit numbers as well.
    single = denoised.vertices.astype(np.float32).astype(np.float64) - noisy.vertices.astype(np.float32)
    assert np.linalg.norm(single, axis=1).max() <= denoised.max_shift + 1e-7


def test_vertices_outside_the_region_keep_their_bits() -> None:
    noisy, _ = with_noise(sphere(3), 0.2)
    denoised = denoise(noisy, DenoiseOptions(region=Box((0.0, -2, -2), (2.0, 2, 2))))
    outside = noisy.vertices[:, 0] < 0
    assert denoised.vertices[outside].tobytes() == noisy.vertices[outside].tobytes()
    assert (denoised.shift[~outside] > 0).all()
    with pytest.raises(OptionError, match="no vertex"):
        denoise(noisy, DenoiseOptions(region=Box((5.0, 5, 5), (6.0, 6, 6))))


def test_the_same_input_gives_the_same_bytes() -> None:
    noisy, _ = with_noise(relief(36), 0.2)
    first, second = denoise(noisy), denoise(noisy)
    assert first.vertices.tobytes() == second.vertices.tobytes()


def test_a_surface_without_noise_stays_as_it_is() -> None:
    mesh = open_grid(30)
    denoised = denoise(mesh)
    assert denoised.vertices.tobytes() == mesh.vertices.tobytes()
    assert "no noise" in denoised.warnings[0]


def test_pieces_rims_shared_edges_and_lonely_vertices_are_no_obstacle() -> None:
    ball, plate = sphere(3), moved(roof(20), (5.0, 0.0, 0.0))
    clean = joined(ball, plate, TriangleMesh(np.array([[9.0, 9, 9]]), np.zeros((0, 3), np.int64)))
    noisy, _ = with_noise(clean, 0.2)
    # Three triangles at one edge, one without area, and two that repeat others.
    third = [[*clean.triangles[0, :2].tolist(), len(ball.vertices)], [0, 1, 0], *clean.triangles[:2].tolist()]
    broken = TriangleMesh(noisy.vertices, np.concatenate([noisy.triangles, third]))
    denoised = denoise(broken)
    assert np.isfinite(denoised.vertices).all()
    assert denoised.shift[-1] == 0.0
    assert normal_error(clean, denoised.vertices) < 0.6 * normal_error(clean, noisy.vertices)


def test_a_mesh_too_small_for_patches_is_denoised_without() -> None:
    noisy, noise = with_noise(sphere(1), 0.1)
    denoised = denoise(noisy, DenoiseOptions(noise=noise))
    assert denoised.scale is None
    assert "no patches took part" in denoised.warnings[0]
    assert denoised.shift.max() <= 4 * noise


def test_noise_larger_than_the_mesh_is_refused() -> None:
    with pytest.raises(OptionError, match="only"):
        denoise(sphere(2), DenoiseOptions(noise=1e300))


@pytest.mark.parametrize(
    "values",
    [
        {"noise": 0},
        {"noise": True},
        {"noise": "1"},
        {"max_shift": float("inf")},
        {"max_shift": -1.0},
        {"region": {"min": [0, 0, 0]}},
        {"region": {"min": [0, 0, 0], "max": [1, 1, float("nan")]}},
        {"region": {"min": [2, 0, 0], "max": [1, 1, 1]}},
        {"region": {"min": [0, 0, 0], "max": [1, 1, 1], "other": 1}},
        {"region": ""},
        {"region": 5},
        {"seed": -1},
        {"patches": {"length": 0}},
        {"patches": 3},
        {"unknown": 1},
    ],
)
def test_options_that_do_not_fit_are_refused(values: dict[str, Any]) -> None:
    with pytest.raises(OptionError):
        DenoiseOptions.from_dict(values)


def test_options_come_from_plain_values() -> None:
    values = {"noise": 0.1, "region": {"min": [0, 0, 0], "max": [1, 2, 3]}, "patches": {"overlap": 1}, "seed": 4}
    options = DenoiseOptions.from_dict(values)
    assert options.region == Box((0.0, 0.0, 0.0), (1.0, 2.0, 3.0))
    assert (options.noise, options.patches.overlap, options.seed) == (0.1, 1, 4)
    assert DenoiseOptions.from_dict({"region": "mask"}).region == "mask"
