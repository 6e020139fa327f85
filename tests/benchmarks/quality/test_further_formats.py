import base64
import gzip
import struct
import zlib

import numpy as np
import pytest

from benchmarks.quality.further_formats import read_gifti, read_msh
from tests.quadpatch.shapes import sphere

BALL = sphere(1)


def test_a_mujoco_mesh_comes_back_with_normals_and_texture_skipped() -> None:
    n, m = len(BALL.vertices), len(BALL.triangles)
    body = BALL.vertices.astype("<f4").tobytes() + np.ones((n, 3), "<f4").tobytes() + np.ones((n, 2), "<f4").tobytes()
    mesh = read_msh(struct.pack("<4i", n, n, n, m) + body + BALL.triangles.astype("<i4").tobytes())
    np.testing.assert_allclose(mesh.vertices, BALL.vertices, atol=1e-7)
    np.testing.assert_array_equal(mesh.triangles, BALL.triangles)


@pytest.mark.parametrize("is_zipped", [False, True])
def test_a_gifti_surface_comes_back_zipped_or_not(is_zipped: bool) -> None:
    arrays = "".join(
        f'<DataArray Intent="NIFTI_INTENT_{intent}"><Data>'
        f"{base64.b64encode(zlib.compress(values.tobytes())).decode()}</Data></DataArray>"
        for intent, values in (
            ("POINTSET", BALL.vertices.astype("<f4")),
            ("TRIANGLE", BALL.triangles.astype("<i4")),
        )
    )
    data = f"<GIFTI>{arrays}</GIFTI>".encode()
    mesh = read_gifti(gzip.compress(data) if is_zipped else data)
    np.testing.assert_allclose(mesh.vertices, BALL.vertices, atol=1e-7)
    np.testing.assert_array_equal(mesh.triangles, BALL.triangles)
