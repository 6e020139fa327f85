import numpy as np
import torch
from hypothesis import given
from hypothesis import strategies as st

from training.holes import LARGEST, N_TURNS, Holes, draw_holes, turn

CPU = torch.device("cpu")


def one_hole(centre: tuple[float, float], width: float, is_square: bool) -> Holes:
    return Holes(np.array([centre]), np.array([width]), np.array([is_square]))


def test_squares_and_circles_cover_their_area() -> None:
    for width in (0.1, 0.5, 0.8):
        square, circle = (
            (~one_hole((0.5, 0.5), width, is_square).cut(200, CPU)).double().mean() for is_square in (True, False)
        )
        assert abs(float(square) - width**2) < 0.01
        assert abs(float(circle) - np.pi * width**2 / 4) < 0.01


def test_a_hole_at_the_border_is_cut_off_there() -> None:
    known = one_hole((0.0, 1.0), 0.5, True).cut(8, CPU)[0]
    expected = torch.ones(8, 8, dtype=torch.bool)
    expected[:2, 6:] = False
    assert torch.equal(known, expected)


def test_a_hole_of_no_width_takes_nothing() -> None:
    assert one_hole((0.3, 0.3), 0.0, True).cut(24, CPU).all()


@given(seed=st.integers(0, 1000))
def test_drawn_holes_follow_from_their_generator_and_leave_something_to_see(seed: int) -> None:
    one, two = (draw_holes(50, np.random.default_rng(seed)).cut(24, CPU) for _ in range(2))
    assert torch.equal(one, two)
    assert (one.double().mean(dim=(1, 2)) > 1 - (LARGEST + 1 / 24) ** 2).all()


def test_holes_are_as_often_square_as_round_and_of_every_size_and_place() -> None:
    holes = draw_holes(20_000, np.random.default_rng(0))
    assert abs(holes.is_square.mean() - 0.5) < 0.02
    for values, high in ((holes.width, LARGEST), (holes.centre[:, 0], 1.0), (holes.centre[:, 1], 1.0)):
        np.testing.assert_allclose(
            np.quantile(values, [0.0, 0.25, 0.5, 0.75, 1.0]), high * np.linspace(0, 1, 5), atol=0.02
        )


def test_the_eight_turns_are_the_eight_symmetries_of_a_square() -> None:
    grid = np.arange(9).reshape(3, 3)
    rotated = turn(torch.from_numpy(np.repeat(grid[None], N_TURNS, 0)), np.arange(N_TURNS)).numpy()
    symmetries = [np.rot90(g, k) for g in (grid, grid.T) for k in range(4)]
    np.testing.assert_array_equal(rotated, symmetries)
    assert len(np.unique(rotated.reshape(8, 9), axis=0)) == 8
