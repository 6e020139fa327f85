from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
import trimesh

from quadpatch.compression.encode import EncodeOptions
from quadpatch.denoising.options import DenoiseOptions
from quadpatch.errors import OptionError
from quadpatch.formats.reading import read_scan
from quadpatch.formats.units import METRES
from quadpatch.options import RepairOptions
from quadpatch.repair import repair_file
from quadpatch.restoration.restore import RestoreOptions
from quadpatch.tasks.decode import decode_file
from quadpatch.tasks.denoise import denoise_file
from quadpatch.tasks.encode import encode_file
from quadpatch.tasks.restore import restore_file
from quadpatch.types import TriangleMesh
from quadpatch_rules.option_words import LengthUnit
from tests.quadpatch.shapes import punched, sphere, write_ply

BALL = sphere(3, radius=10.0)


def filled(folder: Path, **options: Any) -> dict[str, Any]:
    source = write_ply(folder / "in.ply", punched(BALL, (0, 0, 10.0), radius=3.0))
    return repair_file(source, folder / "out.glb", "smooth", RepairOptions(**options))


def restored(folder: Path, **options: Any) -> dict[str, Any]:
    vertices = np.array(BALL.vertices)
    vertices[::9] = np.nan
    source = write_ply(folder / "in.ply", TriangleMesh(vertices, BALL.triangles))
    return restore_file(source, folder / "out.glb", options=RestoreOptions(**options)).report


def denoised(folder: Path, **options: Any) -> dict[str, Any]:
    source = write_ply(folder / "in.ply", BALL)
    return denoise_file(source, folder / "out.glb", options=DenoiseOptions(noise=0.01, **options)).report


def encoded(folder: Path, **options: Any) -> dict[str, Any]:
    source = write_ply(folder / "in.ply", BALL)
    encode_file(source, folder / "out.qpz", options=EncodeOptions(0.2, **options))
    return decode_file(folder / "out.qpz", folder / "out.glb").report


@pytest.mark.parametrize("task", [filled, restored, denoised, encoded])
def test_a_scan_in_millimetres_comes_back_as_glb_in_metres(task: Callable[..., dict[str, Any]], tmp_path: Path) -> None:
    assert task(tmp_path, length_unit="millimeter")["length_unit"] == "millimeter"
    extents = trimesh.load(tmp_path / "out.glb").extents
    assert np.allclose(extents, 0.02, atol=0.001)


def test_without_a_unit_the_numbers_stay_and_a_warning_says_how_to_name_it(tmp_path: Path) -> None:
    report = filled(tmp_path)
    assert report["length_unit"] == "mesh units"
    assert any("length_unit" in warning for warning in report["warnings"])
    assert np.allclose(trimesh.load(tmp_path / "out.glb").extents, 20.0, atol=0.5)


def test_measured_vertices_keep_their_bits_whatever_the_unit(tmp_path: Path) -> None:
    source = write_ply(tmp_path / "in.ply", punched(BALL, (0, 0, 10.0), radius=3.0))
    repair_file(source, tmp_path / "out.ply", "smooth", RepairOptions(length_unit="inch"))
    after = read_scan(tmp_path / "out.ply").vertices[: len(BALL.vertices)]
    assert after.tobytes() == read_scan(source).vertices.tobytes()


def test_a_file_that_states_another_unit_is_believed(tmp_path: Path) -> None:
    filled(tmp_path, length_unit="millimeter")
    with pytest.raises(OptionError, match="the file says that its lengths are in meter"):
        repair_file(tmp_path / "out.glb", tmp_path / "again.glb", "smooth", RepairOptions(length_unit="millimeter"))
    repair_file(tmp_path / "out.glb", tmp_path / "again.glb", "smooth", RepairOptions(length_unit="meter"))


def test_every_unit_has_a_size_and_no_other_word_is_one() -> None:
    assert set(METRES) == set(get_args(LengthUnit))
    for make in (RepairOptions, RestoreOptions, DenoiseOptions):
        with pytest.raises(OptionError, match="length_unit"):
            make(length_unit="furlong")  # type: ignore[arg-type]
    with pytest.raises(OptionError, match="length_unit"):
        EncodeOptions(0.1, length_unit="furlong")  # type: ignore[arg-type]
