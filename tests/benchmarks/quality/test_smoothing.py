from pathlib import Path

import numpy as np
import pytest

from benchmarks.quality.smoothing import kept_smoothing
from quadpatch.patches.paper_layout import smooth_for_quads
from tests.quadpatch.shapes import bumpy_plate


def test_a_smoothed_mesh_is_taken_from_the_folder_the_second_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mesh, other = bumpy_plate(8, 2.0), bumpy_plate(9, 2.0)
    expected = smooth_for_quads(mesh)
    with kept_smoothing(tmp_path):
        assert smooth_for_quads(mesh).vertices.tobytes() == expected.vertices.tobytes()
        (kept,) = tmp_path.iterdir()
        np.save(kept, np.zeros_like(mesh.vertices))
        assert not smooth_for_quads(mesh).vertices.any()
        assert smooth_for_quads(other).vertices.any()
    assert smooth_for_quads(mesh).vertices.tobytes() == expected.vertices.tobytes()
