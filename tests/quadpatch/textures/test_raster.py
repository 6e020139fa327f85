import numpy as np
import pytest

from quadpatch.textures import raster
from quadpatch.textures.raster import rasterise

SQUARE = np.array([[[2.0, 3.0], [10.0, 3.0], [10.0, 9.0]], [[2.0, 3.0], [10.0, 9.0], [2.0, 9.0]]])


def covered(corners: np.ndarray) -> list[np.ndarray]:
    parts = list(rasterise(corners))
    names = ("triangle", "row", "column", "weights")
    return [np.concatenate([getattr(part, name) for part in parts]) for name in names]


def test_two_triangles_of_a_square_cover_its_texels() -> None:
    _, row, column, _ = covered(SQUARE)
    found = {*zip(row.tolist(), column.tolist(), strict=True)}
    assert found == {(i, j) for i in range(3, 9) for j in range(2, 10)}


def test_weights_lead_to_the_middles_of_texels() -> None:
    triangle, row, column, weights = covered(SQUARE)
    places = np.einsum("kc,kcx->kx", weights, SQUARE[triangle])
    assert np.allclose(places, np.stack([column + 0.5, row + 0.5], axis=1))


def test_triangles_smaller_than_a_texel_or_without_area_cover_at_most_one() -> None:
    tiny = np.array([[[0.4, 0.4], [0.6, 0.4], [0.5, 0.7]], [[1.1, 1.1], [1.3, 1.1], [1.2, 1.3]], [[2.5, 2.5]] * 3])
    triangle, row, column, _ = covered(tiny)
    assert (triangle.tolist(), row.tolist(), column.tolist()) == ([0], [0], [0])


def test_chunks_make_no_difference(monkeypatch: pytest.MonkeyPatch) -> None:
    corners = np.random.default_rng(0).uniform(0, 40, (50, 3, 2))
    whole = covered(corners)
    monkeypatch.setattr(raster, "_CHUNK", 64)
    for one, other in zip(whole, covered(corners), strict=True):
        assert (one == other).all()
