import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.networks.residual import LEAST_ERROR, ROUNDING, SLOPES, Residual, errors, rotated
from quadpatch.patches.residual_input import CHANNELS
from tests.quadpatch.networks.made import random_tensor, stirred


@pytest.mark.parametrize("widths", [(16,), (16, 32), (8, 16, 24)])
@pytest.mark.parametrize("side", [8, 24, 32])
def test_an_untrained_network_leaves_every_fill_as_it_is(widths: tuple[int, ...], side: int) -> None:
    answer = Residual(widths)(random_tensor(0, 3, CHANNELS, side, side))
    assert answer.shape == (3, 1, side, side)
    assert (answer == 0).all()


def test_every_weight_takes_part_once_training_has_begun() -> None:
    network = stirred(Residual((8, 16, 24)))
    network(random_tensor(0, 2, CHANNELS, 16, 16)).square().sum().backward()
    for name, parameter in network.named_parameters():
        assert parameter.grad is not None, name
        assert parameter.grad.abs().max() > 0, name


def test_each_patch_is_answered_by_itself() -> None:
    network, patches = stirred(Residual()), random_tensor(1, 3, CHANNELS, 32, 32)
    with torch.inference_mode():
        together, alone = network(patches), torch.cat([network(patch[None]) for patch in patches])
    torch.testing.assert_close(together, alone, atol=1e-5, rtol=1e-5)


def rounded_off(wrong: float) -> float:
    return float(np.hypot(wrong, ROUNDING)) - ROUNDING


def test_errors_are_those_computed_by_hand() -> None:
    """One patch of 2 x 2 bins of which three are asked; the network is wrong by 1, 0 and -2 there."""
    correction = torch.tensor([[[[1.0, 2.0], [3.0, 50.0]]]])
    answer = torch.tensor([[[[2.0, 2.0], [1.0, -7.0]]]])
    loss_mask = torch.tensor([[[[1.0, 1.0], [1.0, 0.0]]]])
    found = errors(answer, correction, loss_mask)
    assert found.network.item() == pytest.approx((1 + 0 + 2) / 3)
    assert found.fill.item() == pytest.approx((1 + 2 + 3) / 3)
    slopes = (abs(0 - 1) + abs(0 + 2)) + (abs(-2 - 1) + abs(0 - 0))
    loss = 3 / 3 + SLOPES * slopes / 3
    assert found.loss.item() == pytest.approx(loss)
    rounded = sum(rounded_off(wrong) for wrong in (1, 0, 2)) / 3
    rounded_slopes = sum(rounded_off(step) for step in (1, 2, 3, 0)) / 3
    relative = (rounded + SLOPES * rounded_slopes) / (6 / 3 + LEAST_ERROR)
    assert found.relative_loss.item() == pytest.approx(relative)


def test_a_right_answer_costs_nothing_whatever_it_says_elsewhere() -> None:
    correction, loss_mask = random_tensor(0, 4, 1, 8, 8), (random_tensor(1, 4, 1, 8, 8) > 0).float()
    answer = torch.where(loss_mask > 0, correction, 100.0)
    found = errors(answer, correction, loss_mask)
    assert found.network.item() == found.loss.item() == found.relative_loss.item() == 0
    assert found.fill.item() > 0.5


def test_patches_that_nothing_is_asked_of_cost_nothing() -> None:
    correction = random_tensor(0, 2, 1, 8, 8)
    found = errors(correction + 1, correction, torch.zeros_like(correction))
    assert (found.network.item(), found.fill.item(), found.loss.item(), found.relative_loss.item()) == (0, 0, 0, 0)


def test_rough_patches_are_in_charge_where_meshes_are_many_but_not_alone() -> None:
    correction, loss_mask = random_tensor(0, 1, 1, 8, 8), torch.ones(1, 1, 8, 8)
    sizes = (10 * correction, 1000 * correction, 0.1 * correction)
    rough, rougher, smooth = (errors(0.5 * c, c, loss_mask).relative_loss for c in sizes)
    assert rougher.item() == pytest.approx(rough.item(), rel=0.15)
    assert 0.01 * rough.item() < smooth.item() < 0.3 * rough.item()


@settings(max_examples=25)
@given(turns=st.integers(0, 3), mirrored=st.booleans(), seed=st.integers(0, 100))
def test_turns_are_undone_by_their_inverse(turns: int, mirrored: bool, seed: int) -> None:
    tensors = random_tensor(seed, 2, 2, 6, 6), random_tensor(seed + 1, 2, 1, 6, 6)
    back = rotated(rotated(rotated(tensors, turns, mirrored=mirrored), 0, mirrored=mirrored), -turns, mirrored=False)
    assert all(torch.equal(one, other) for one, other in zip(back, tensors, strict=True))


def test_there_are_eight_turns_and_all_tensors_take_the_same() -> None:
    square = random_tensor(0, 1, 1, 5, 5)
    seen = set()
    for turns in range(4):
        for mirrored in (False, True):
            one, other = rotated((square, torch.cat([square, square], dim=1)), turns, mirrored=mirrored)
            assert torch.equal(other[:, :1], one)
            assert torch.equal(other[:, 1:], one)
            seen.add(tuple(one.flatten().tolist()))
    assert len(seen) == 8
