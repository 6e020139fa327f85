import numpy as np
import pytest

from quadpatch.colours.cells import frames_along
from quadpatch.colours.patches import RESOLUTION, SHIFTS, PatchSampler
from quadpatch.colours.surface import ColouredSurface
from quadpatch.patches.seeds import Seeds
from tests.quadpatch.shapes import open_grid

MESH = open_grid(61)
GAP = np.where(np.linalg.norm(MESH.vertices[:, :2], axis=1) < 5.0, 0, -1)
# Red along x, green along y.
SURFACE = ColouredSurface.of_measured(MESH, 100 + 2 * MESH.vertices, GAP, 1, 1.0)
SAMPLER = PatchSampler(SURFACE, 12.0)


def test_bins_have_the_colour_of_the_surface_over_them() -> None:
    seeds = Seeds(np.array([[15.0, 10.0, 0.0]]), np.eye(3)[np.newaxis], np.zeros(1, np.int64))
    (colours,) = SAMPLER.cut(seeds).colours
    steps = ((np.arange(RESOLUTION) + 0.5) / RESOLUTION - 0.5) * 12.0
    assert colours.shape == (RESOLUTION, RESOLUTION, 3)
    # A bin has the mean colour of a triangle, which reaches two thirds of an edge from its middle.
    assert np.allclose(colours[:, :, 0], 100 + 2 * (15 + steps)[np.newaxis], atol=2 * 0.67)
    assert np.allclose(colours[:, :, 1], 100 + 2 * (10 + steps)[:, np.newaxis], atol=2 * 0.67)


def test_bins_over_a_gap_are_seen_but_not_known() -> None:
    seeds = Seeds(np.zeros((1, 3)), np.eye(3)[np.newaxis], np.zeros(1, np.int64))
    patches = SAMPLER.cut(seeds).patches
    assert patches.seen.all()
    assert not patches.known[0, RESOLUTION // 2, RESOLUTION // 2]
    assert patches.known[0, 0, 0]


def test_sources_show_measured_colours_and_are_turned_about_the_normal() -> None:
    sources = SAMPLER.sources(40, np.random.default_rng(0))
    assert len(sources) == 40
    assert sources.patches.resolution == RESOLUTION + 2 * max(SHIFTS)
    assert (sources.patches.known.mean(axis=(1, 2)) >= 0.9).all()
    assert np.allclose(sources.patches.frames[:, 2], (0, 0, 1))
    assert len(np.unique(sources.patches.frames[:, 0], axis=0)) == 40


def test_a_source_is_as_large_as_a_patch_and_its_shifts() -> None:
    seeds = Seeds(np.array([[15.0, 10.0, 0.0]]), frames_along(np.array([[0.0, 0.0, 1.0]])), np.zeros(1, np.int64))
    assert SAMPLER.cut(seeds, 2).patches.length == pytest.approx(12.0 * (RESOLUTION + 4) / RESOLUTION)
