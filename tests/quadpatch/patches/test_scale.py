import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.options import PatchOptions
from quadpatch.patches.scale import (
    EDGES_PER_BIN,
    HOLES_PER_LENGTH,
    OVERLAP,
    RESOLUTION_RANGE,
    choose_scale,
    coarse_edge_length,
)

AUTO = PatchOptions()
lengths = st.floats(1e-6, 1e6)


def test_a_patch_sees_more_known_surface_than_hole() -> None:
    scale = choose_scale([1.0, 1.0, 1.0], 0.1, AUTO)
    assert scale.length == pytest.approx(HOLES_PER_LENGTH)
    assert scale.length / scale.resolution == pytest.approx(EDGES_PER_BIN * 0.1, rel=0.1)
    assert scale.overlap == OVERLAP


def test_one_huge_hole_among_many_does_not_set_the_length() -> None:
    assert choose_scale([1.0] * 9 + [50.0], 0.1, AUTO).length == pytest.approx(HOLES_PER_LENGTH)


@given(diameters=st.lists(lengths, min_size=1, max_size=5), edge=lengths, power=st.integers(-30, 30))
def test_a_larger_mesh_has_as_much_larger_patches_of_the_same_resolution(
    diameters: list[float], edge: float, power: int
) -> None:
    small = choose_scale(diameters, edge, AUTO)
    large = choose_scale([2.0**power * diameter for diameter in diameters], 2.0**power * edge, AUTO)
    assert large.length == 2.0**power * small.length
    assert large.resolution == small.resolution


@given(diameters=st.lists(lengths, max_size=5), edge=lengths, model=st.none() | st.integers(8, 128))
def test_resolutions_stay_in_range_and_bins_are_never_much_finer_than_edges(
    diameters: list[float], edge: float, model: int | None
) -> None:
    scale = choose_scale(diameters, edge, AUTO, model)
    assert scale.resolution == model if model else RESOLUTION_RANGE[0] <= scale.resolution <= RESOLUTION_RANGE[1]
    assert scale.length / scale.resolution > 0.95 * EDGES_PER_BIN * edge


def test_what_is_set_is_taken_but_a_model_keeps_its_resolution() -> None:
    options = PatchOptions(3.0, 20, 0)
    scale = choose_scale([1.0], 0.1, options)
    assert (scale.length, scale.resolution, scale.overlap) == (3.0, 20, 0)
    assert choose_scale([1.0], 0.1, options, model_resolution=24).resolution == 24


def test_edges_may_be_as_long_as_those_that_such_bins_are_chosen_for() -> None:
    fine = choose_scale([1.0], 0.01, AUTO)
    length = coarse_edge_length(fine, 0.01)
    assert length is not None
    assert length > 0.02
    assert choose_scale([1.0], length, AUTO) == fine
    # Bins no wider than an edge or so show triangles of the scan.
    assert coarse_edge_length(choose_scale([1.0], 0.07, AUTO), 0.07) is None
