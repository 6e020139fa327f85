import json
from dataclasses import replace

import numpy as np
import pytest

from quadpatch.calibration.calibration_set import CalibrationSet, cut_calibration_set
from quadpatch.calibration.energy_selection import EnergyBlend, learn_energy_blend
from quadpatch.calibration.error_model import ErrorModel
from quadpatch.calibration.record import CalibrationRecord, record_of
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.recipes.fairing_energies import DEFAULT_ENERGY, FAIRING_ENERGIES
from quadpatch.types import TriangleMesh
from tests.quadpatch.calibration.test_crease_selection import folded_paper
from tests.quadpatch.shapes import sphere

RNG = np.random.default_rng(5)
N_ENERGIES = len(FAIRING_ENERGIES)
ROWS = RNG.random((24, N_ENERGIES))
RECORD = CalibrationRecord(
    EnergyBlend(
        list(FAIRING_ENERGIES), -7 * RNG.random(N_ENERGIES), -7 * RNG.random(N_ENERGIES), 3, 0.1 + 0.2, 0.7 - 0.1
    ),
    ErrorModel(1 / 3, 0.7),
    0.75,
    True,
    ROWS / ROWS.sum(axis=1, keepdims=True),
    1.25,
)


def through_json(record: CalibrationRecord) -> CalibrationRecord:
    return record_of(json.loads(json.dumps(record.plain())))


def test_a_record_comes_back_from_json_with_the_same_bits() -> None:
    again = through_json(RECORD)
    assert again.plain() == RECORD.plain()
    assert RECORD.weights is not None
    assert again.weights is not None
    assert again.weights.tobytes() == RECORD.weights.tobytes()
    assert again.blend.log_error.tobytes() == RECORD.blend.log_error.tobytes()
    assert again.blend.energies == list(FAIRING_ENERGIES)
    assert (again.n_holes, through_json(replace(RECORD, weights=None)).n_holes) == (24, 0)


def cut(mesh: TriangleMesh, diameter: float) -> CalibrationSet:
    holes = cut_calibration_set(mesh, diameter, mean_edge_length(mesh), np.random.default_rng(0))
    assert holes is not None
    return holes


# By one energy, and by a blend of several.
SMALL_HOLES = {"sphere": (sphere(4), 0.3, True), "paper": (folded_paper(81), 0.2, False)}


@pytest.mark.parametrize("name", SMALL_HOLES)
def test_holes_that_are_small_for_their_edges_are_filled_again_with_the_same_bits(name: str) -> None:
    mesh, diameter, by_one = SMALL_HOLES[name]
    holes = cut(mesh, diameter)
    blend, filled = learn_energy_blend(holes, FAIRING_ENERGIES, DEFAULT_ENERGY)
    assert (holes.is_graded, len(blend.energies) == 1) == (False, by_one)
    record = CalibrationRecord(blend, RECORD.error_model, 0.0, holes.is_graded, filled.energy_weights)
    again = through_json(record).fill(cut(mesh, diameter))
    assert again.mesh.vertices.tobytes() == filled.mesh.vertices.tobytes()
    assert again.mesh.triangles.tobytes() == filled.mesh.triangles.tobytes()
