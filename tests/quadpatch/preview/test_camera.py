import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.preview.camera import View, view_of
from quadpatch.types import FloatArray


def unit(vector: FloatArray) -> FloatArray:
    return np.asarray(vector / np.linalg.norm(vector))


@given(seed=st.integers(0, 2**32 - 1), aspect=st.floats(0.3, 3))
def test_every_point_lies_inside_the_picture_and_one_nearly_touches_its_margin(seed: int, aspect: float) -> None:
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(50, 3)) * rng.uniform(0.1, 10, 3) + rng.uniform(-100, 100, 3)
    camera = view_of(points, unit(rng.normal(size=3)), aspect)
    across = (points - camera.centre) @ camera.right / (camera.width / 2)
    upwards = (points - camera.centre) @ camera.up / (camera.width / 2 / aspect)
    widest = max(np.abs(across).max(), np.abs(upwards).max())
    assert widest == pytest.approx(1 / 1.1)


@given(seed=st.integers(0, 2**32 - 1))
def test_axes_are_orthonormal_and_right_handed_with_y_upwards(seed: int) -> None:
    towards = unit(np.random.default_rng(seed).normal(size=3))
    camera = view_of(np.eye(3), towards, 1.0)
    axes = np.stack([camera.right, camera.up, camera.towards])
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1)
    assert camera.up[1] >= 0 or abs(towards[1]) > 0.95


@pytest.mark.parametrize("towards", [(0.0, 1.0, 0.0), (0.0, -1.0, 0.0)])
def test_a_view_along_y_still_has_axes(towards: tuple[float, float, float]) -> None:
    camera = view_of(np.eye(3), np.array(towards), 1.0)
    assert np.isfinite(camera.right).all()
    assert abs(camera.right @ camera.towards) < 1e-12


@given(seed=st.integers(0, 2**32 - 1))
def test_a_view_like_another_is_turned_the_shortest_way(seed: int) -> None:
    rng = np.random.default_rng(seed)
    one = view_of(np.eye(3), unit(rng.normal(size=3)), 1.0)
    towards = unit(one.towards + 0.8 * unit(rng.normal(size=3)))
    other = view_of(np.eye(3), towards, 1.0, like=one)
    axes = np.stack([other.right, other.up, other.towards])
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    # No turn is shorter than the angle between the two directions.
    turn = (np.trace(axes @ np.stack([one.right, one.up, one.towards]).T) - 1) / 2
    assert turn == pytest.approx(one.towards @ towards, abs=1e-9)


def test_rays_of_the_pixel_grid_start_in_front_of_all_points() -> None:
    points = np.random.default_rng(0).normal(size=(20, 3))
    camera = view_of(points, unit(np.array([1.0, 2, 3])), 2.0)
    view = View(camera, (100, 50))
    origins = np.array([[1.0, 0, 0], [1, 50, 25], [1, 100, 50]]) @ view.plane
    assert (origins @ camera.towards).min() >= (points @ camera.towards).max()
    np.testing.assert_allclose(origins[1] - camera.clearance * camera.towards, camera.centre, atol=1e-12)
    columns, rows = view.places(origins)
    np.testing.assert_allclose(columns, [0, 50, 100], atol=1e-9)
    np.testing.assert_allclose(rows, [0, 25, 50], atol=1e-9)
    # The first pixel is at the upper left.
    assert (origins[0] - camera.centre) @ camera.right == pytest.approx(-camera.width / 2)
    assert (origins[0] - camera.centre) @ camera.up == pytest.approx(camera.width / 4)


def test_a_single_point_gets_a_picture_of_some_width() -> None:
    assert view_of(np.ones((1, 3)), np.array([0.0, 0, 1]), 1.0).width > 0
