import numpy as np
import pytest

from quadpatch.errors import OptionError
from quadpatch.sparse.ksvd import KsvdOptions
from training.corpus import PatchRecipe
from training.dictionary import LearningOptions, learn_dictionary

OPTIONS = LearningOptions(
    PatchRecipe(resolution=8, scales=(1.0,), max_seeds=30),
    KsvdOptions(20, 3, 3),
    n_procedural=1,
    relief_side=30,
    seed=2,
)


def test_reliefs_alone_teach_a_dictionary_that_codes_unseen_reliefs() -> None:
    heard: list[tuple[str, float]] = []
    iterations: list[int] = []
    learned = learn_dictionary(
        [], [], OPTIONS, lambda stage, fraction: heard.append((stage, fraction)), lambda i, _: iterations.append(i)
    )
    assert 100 < learned.n_patches <= 300
    assert iterations == [0, 1, 2]
    assert learned.errors[-1] < learned.errors[0] < 1.0
    # Unseen patches, whole: three atoms of twenty explain more than the mean does.
    assert learned.metrics["relief_hole_25_error"] / learned.metrics["relief_hole_25_to_unhidden"] < 1.0
    for stage in ("training patches", "held-out reliefs"):
        fractions = [fraction for name, fraction in heard if name == stage]
        assert fractions == sorted(fractions)
        assert fractions[-1] == 1.0
    # What was measured is what a file will hold.
    atoms = learned.dictionary.atoms
    rounded = atoms.astype(np.float32).astype(np.float64)
    np.testing.assert_allclose(atoms, rounded / np.linalg.norm(rounded, axis=0), rtol=0, atol=1e-9)


def test_no_mesh_and_no_relief_give_nothing_to_learn() -> None:
    with pytest.raises(OptionError, match="0 patches"):
        learn_dictionary([], [], LearningOptions())
