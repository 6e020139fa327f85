import json
from pathlib import Path

import numpy as np
import pytest

from quadpatch.errors import OptionError
from quadpatch.formats.reading import read_scan
from quadpatch.formats.vertex_properties import vertex_property
from quadpatch.options import DictionaryOptions, PatchOptions
from quadpatch.reconstruction.whole_surface import ReconstructOptions
from quadpatch.tasks.reconstruct import reconstruct_file
from tests.quadpatch.shapes import relief, write_ply

ROUGH = relief(40)
SMALL = ReconstructOptions(PatchOptions(resolution=8), DictionaryOptions(atoms=24, nonzero=6))


def test_a_file_is_rebuilt_from_its_patches(tmp_path: Path) -> None:
    source, output = write_ply(tmp_path / "in.ply", ROUGH), tmp_path / "out.ply"
    report = reconstruct_file(source, output, options=SMALL).report
    after = read_scan(output)
    error = np.linalg.norm(after.vertices - ROUGH.vertices, axis=1)
    seen = vertex_property(after, "overlap") > 0
    np.testing.assert_allclose(vertex_property(after, "reconstruction_error"), error, rtol=1e-5, atol=1e-12)
    assert report["error"]["rms"] == pytest.approx(np.sqrt((error[seen] ** 2).mean()))
    assert report["psnr"] > 45
    assert report["vertices"] == {"rebuilt": int(seen.sum()), "unseen": int((~seen).sum())}
    assert report["nonzero_coefficients"] <= 6 * report["patches"]["count"]
    np.testing.assert_array_equal(after.triangles, ROUGH.triangles)
    json.dumps(report, allow_nan=False)


def test_a_shipped_dictionary_rebuilds_a_file(tmp_path: Path) -> None:
    source, output = write_ply(tmp_path / "in.ply", ROUGH), tmp_path / "out.ply"
    report = reconstruct_file(source, output, "general-dictionary").report
    assert report["model"]["kind"] == "dictionary"
    assert report["psnr"] > 40


def test_a_network_rebuilds_nothing(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match="network"):
        reconstruct_file(write_ply(tmp_path / "in.ply", ROUGH), tmp_path / "out.ply", "general-residual")


def test_a_shipped_dictionary_has_a_size_of_its_own(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match="own"):
        reconstruct_file(write_ply(tmp_path / "in.ply", ROUGH), tmp_path / "out.ply", "general-dictionary", SMALL)
