from dataclasses import replace

import numpy as np
import pytest

from quadpatch.patches.layout import Sampled
from quadpatch.patches.normalisation import HEIGHTS, NORMALISATION
from quadpatch.reconstruction.coding import PatchDictionary, code_patches, decoded_heights
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.types import FloatArray, Patches

N = 4


def sampled(heights: FloatArray, base: FloatArray | None = None) -> Sampled:
    n = len(heights)
    everywhere = np.ones((n, N, N), bool)
    frames = np.tile(np.eye(3), (n, 1, 1))
    patches = Patches(np.zeros((n, 3)), frames, 1.0, heights, everywhere, everywhere, np.zeros((n, N, N), np.int64))
    return Sampled(patches, np.zeros_like(heights) if base is None else base)


def some_heights(seed: int = 0) -> FloatArray:
    return np.random.default_rng(seed).normal(size=(5, N, N))


@pytest.mark.parametrize("normalisation", [HEIGHTS, NORMALISATION])
def test_a_complete_dictionary_codes_without_an_error(normalisation: str) -> None:
    dictionary = PatchDictionary(Dictionary(np.eye(N * N), N, N * N), normalisation)
    some = sampled(some_heights(), some_heights(1))
    codes = code_patches(some, dictionary)
    np.testing.assert_allclose(decoded_heights(codes, dictionary, some.base_heights), some.patches.heights, atol=1e-12)


def test_unknown_bins_are_never_read() -> None:
    dictionary = PatchDictionary(Dictionary(np.eye(N * N), N, 3))
    some = sampled(some_heights())
    known = some.patches.known.copy()
    known[:, 1, 2] = False
    spoilt = some.patches.heights.copy()
    spoilt[:, 1, 2] = np.nan
    clean = Sampled(replace(some.patches, known=known), some.base_heights)
    dirty = Sampled(replace(some.patches, known=known, heights=spoilt), some.base_heights)
    np.testing.assert_array_equal(code_patches(dirty, dictionary).codes, code_patches(clean, dictionary).codes)


def test_the_base_surface_is_not_read_where_heights_are_coded() -> None:
    dictionary = PatchDictionary(Dictionary(np.eye(N * N), N, 3))
    with_base = code_patches(sampled(some_heights(), some_heights(1)), dictionary)
    np.testing.assert_array_equal(with_base.codes, code_patches(sampled(some_heights()), dictionary).codes)


def test_a_code_ends_at_the_tolerance() -> None:
    dictionary = PatchDictionary(Dictionary(np.eye(N * N), N, N * N))
    some = sampled(some_heights())
    exact, rough = code_patches(some, dictionary), code_patches(some, dictionary, tolerance=0.5)
    assert rough.n_nonzero < exact.n_nonzero
    error = decoded_heights(rough, dictionary, some.base_heights) - some.patches.heights
    assert (np.sqrt((error**2).mean(axis=(1, 2))) <= 0.5).all()
