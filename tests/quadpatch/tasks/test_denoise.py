from pathlib import Path
from typing import Any

import numpy as np
import pytest

from quadpatch.denoising.options import DenoiseOptions
from quadpatch.errors import ModelError, OptionError
from quadpatch.formats.moving import Moved, write_moved
from quadpatch.formats.reading import read_scan
from quadpatch.formats.vertex_properties import vertex_property
from quadpatch.tasks.denoise import denoise_file
from tests.quadpatch.denoising.noisy_shapes import normal_error, with_noise
from tests.quadpatch.shapes import relief, sphere, write_ply


@pytest.fixture
def noisy_file(tmp_path: Path) -> Path:
    return write_ply(tmp_path / "noisy.ply", with_noise(sphere(3), 0.2)[0], "f4")


def test_a_file_keeps_its_triangles_and_says_how_far_each_vertex_moved(noisy_file: Path, tmp_path: Path) -> None:
    result = denoise_file(noisy_file, tmp_path / "out.ply")
    before, after = read_scan(noisy_file), read_scan(tmp_path / "out.ply")
    assert after.triangles.tolist() == before.triangles.tolist()
    shift = np.linalg.norm(after.vertices - before.vertices, axis=1)
    assert np.allclose(vertex_property(after, "shift"), shift, atol=1e-6)
    report = result.report
    assert report["task"] == "denoise"
    assert report["noise_estimated"] is True
    assert report["max_shift"] == pytest.approx(4 * report["noise"])
    assert shift.max() <= report["max_shift"]
    assert report["shift_95"] == pytest.approx(np.percentile(shift, 95), rel=1e-3)
    assert report["shift_mean"] <= report["shift_95"] <= report["shift_max"] <= report["max_shift"]
    assert report["moved_vertices"] == len(shift)
    stages = [stage["name"] for stage in report["stages"]]
    assert (stages[0], stages[-1]) == ("read", "write")
    assert report["warnings"] == []
    assert normal_error(sphere(3), after.vertices) < 0.5 * normal_error(sphere(3), before.vertices)
    assert result.changed.all()


def test_a_vertex_property_says_which_vertices_may_move(noisy_file: Path, tmp_path: Path) -> None:
    scan = read_scan(noisy_file)
    mask = (np.arange(len(scan.vertices)) % 2).astype(np.uint8)
    write_moved(tmp_path / "marked.ply", scan, Moved(scan.vertices, {"mask": mask}))
    denoise_file(tmp_path / "marked.ply", tmp_path / "out.ply", options=DenoiseOptions(region="mask"))
    after = read_scan(tmp_path / "out.ply")
    stays = mask == 0
    assert after.vertices[stays].tobytes() == scan.vertices[stays].tobytes()
    assert (after.vertices != scan.vertices).any(axis=1)[~stays].all()
    assert vertex_property(after, "mask").tolist() == mask.tolist()
    with pytest.raises(OptionError, match="no vertex property"):
        denoise_file(noisy_file, tmp_path / "out.ply", options=DenoiseOptions(region="other"))


def test_the_triangles_of_an_stl_stay_joined(noisy_file: Path, tmp_path: Path) -> None:
    scan = read_scan(noisy_file)
    write_moved(tmp_path / "noisy.stl", scan, Moved(scan.vertices))
    result = denoise_file(tmp_path / "noisy.stl", tmp_path / "out.stl")
    after = read_scan(tmp_path / "out.stl")
    corners = np.unique(after.vertices[after.triangles].reshape(-1, 3), axis=0)
    assert len(corners) == len(scan.vertices)
    assert any("shift left out" in warning for warning in result.report["warnings"])


def test_the_same_file_gives_the_same_bytes(noisy_file: Path, tmp_path: Path) -> None:
    for name in ("first", "second"):
        denoise_file(noisy_file, tmp_path / f"{name}.ply")
    assert (tmp_path / "first.ply").read_bytes() == (tmp_path / "second.ply").read_bytes()


def test_a_reference_is_learned_from(tmp_path: Path) -> None:
    source = write_ply(tmp_path / "noisy.ply", with_noise(relief(50), 0.2)[0], "f4")
    clean = write_ply(tmp_path / "clean.ply", relief(60), "f4")
    report = denoise_file(source, tmp_path / "out.ply", reference=clean).report
    assert report["model"]["name"] == "reference"
    assert report["shares"]["patches"] > 0
    assert report["patches"]["count"] > 0
    with pytest.raises(OptionError, match="reference"):
        denoise_file(source, tmp_path / "out.ply", "smooth", reference=clean)


@pytest.mark.parametrize(("model", "error"), [("general-residual", OptionError), ("no-such-model", ModelError)])
def test_models_that_code_no_patches_are_refused(
    model: str, error: type[Exception], noisy_file: Path, tmp_path: Path
) -> None:
    with pytest.raises(error):
        denoise_file(noisy_file, tmp_path / "out.ply", model)
    assert not (tmp_path / "out.ply").exists()


def test_numbers_of_the_file_that_break_the_bound_are_named(tmp_path: Path) -> None:
    far = sphere(3)
    far.vertices[:] += 1e5
    source = write_ply(tmp_path / "noisy.ply", with_noise(far, 0.2)[0], "f4")
    report = denoise_file(source, tmp_path / "out.ply", options=DenoiseOptions(noise=0.03, max_shift=0.011)).report
    moved = read_scan(tmp_path / "out.ply").vertices - read_scan(source).vertices
    assert (np.linalg.norm(moved, axis=1).max() <= 0.011) == (not _named(report))


def _named(report: dict[str, Any]) -> bool:
    return any("beyond max_shift" in warning for warning in report["warnings"])
