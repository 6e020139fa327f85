import numpy as np

from quadpatch.calibration.sites import pick_sites
from tests.quadpatch.shapes import open_grid

PLATE = open_grid(101)
RIM = np.flatnonzero(np.abs(PLATE.vertices[:, :2]).max(axis=1) == 50)


def test_places_keep_clear_of_rims_and_of_each_other() -> None:
    places = pick_sites(PLATE, RIM, 6.0, 8, np.random.default_rng(0))
    assert len(places) == 8
    assert np.abs(places).max() < 44
    apart = np.linalg.norm(places[:, np.newaxis] - places, axis=2)
    assert apart[np.triu_indices(8, 1)].min() > 12


def test_without_room_there_are_fewer() -> None:
    assert len(pick_sites(PLATE, RIM, 30.0, 8, np.random.default_rng(0))) <= 1
    assert len(pick_sites(PLATE, RIM, 60.0, 8, np.random.default_rng(0))) == 0
