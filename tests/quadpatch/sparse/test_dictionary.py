import numpy as np
import pytest

from quadpatch.errors import ModelError
from quadpatch.sparse.dictionary import Dictionary


def test_a_sound_dictionary_knows_its_size() -> None:
    dictionary = Dictionary(np.eye(9)[:, :5].copy(), 3, 2)
    assert (dictionary.n_bins, dictionary.n_atoms) == (9, 5)


@pytest.mark.parametrize(
    ("atoms", "resolution", "n_nonzero"),
    [
        (np.eye(9), 4, 2),
        (np.eye(9), 3, 0),
        (np.eye(9), 3, 10),
        (np.eye(9)[:, :4], 3, 5),
        (np.eye(9, dtype=np.float32), 3, 2),
        (np.eye(9)[0], 3, 1),
        (np.eye(9) * 1.001, 3, 2),
        (np.zeros((9, 0)), 3, 1),
        (np.where(np.eye(9) > 0, np.nan, 0.0), 3, 2),
        (np.zeros((0, 3)), 0, 1),
    ],
)
def test_a_dictionary_that_does_not_fit_together_is_refused(atoms: np.ndarray, resolution: int, n_nonzero: int) -> None:
    with pytest.raises(ModelError):
        Dictionary(atoms, resolution, n_nonzero)
