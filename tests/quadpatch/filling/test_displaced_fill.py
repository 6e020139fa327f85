import numpy as np

from quadpatch.filling.displaced_fill import displace_without_faults, relax_faults
from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.filling.faults import find_faults
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.types import FloatArray
from tests.quadpatch.shapes import open_grid, punched

HOLED = punched(open_grid(41, 2.0), (-0.5, 0.0, 0.0), (0.5, 0.0, 0.0), radius=0.25)
FILLED = fair_holes(
    close_holes(HOLED, [loop for loop in boundary_loops(HOLED.triangles).loops if len(loop) < 100]), THIN_PLATE
)
BOTH = np.ones(2, bool)


def thrown(hole: int, by: float) -> FloatArray:
    """Move one vertex in the middle of a hole sideways."""
    new = FILLED.mesh.vertices[FILLED.n_measured_vertices :]
    inside = np.flatnonzero(FILLED.vertex_hole == hole)
    middle = inside[np.linalg.norm(new[inside] - new[inside].mean(axis=0), axis=1).argmin()]
    displacement = np.zeros_like(new)
    displacement[middle] = [by, 0.0, 0.0]
    return displacement


def moved(filled: FilledMesh, hole: int) -> bool:
    same = (filled.mesh.vertices == FILLED.mesh.vertices).all(axis=1)
    return not same[FILLED.n_measured_vertices :][FILLED.vertex_hole == hole].all()


def test_what_folds_is_taken_back_and_what_does_not_stays() -> None:
    displacement = thrown(0, 0.3) + thrown(1, 1e-3)
    found = displace_without_faults(FILLED, displacement, BOTH, find_faults(FILLED), None)
    assert found.undone.tolist() == [True, False]
    assert not moved(found.filled, 0)
    assert moved(found.filled, 1)
    assert not found.faults.is_wrong.any()


def test_loops_that_are_not_wanted_stay() -> None:
    found = displace_without_faults(FILLED, thrown(0, 1e-3), ~BOTH, find_faults(FILLED), None)
    assert not moved(found.filled, 0)
    assert not found.undone.any()


def test_folds_are_relaxed_where_that_is_wanted() -> None:
    folded = FILLED.displaced(thrown(0, 0.15))
    assert find_faults(folded).is_doubtful.tolist() == [True, False]
    assert not find_faults(relax_faults(folded, BOTH, None)).is_doubtful.any()
    only_the_other = relax_faults(folded, np.array([False, True]), None)
    assert only_the_other.mesh.vertices.tobytes() == folded.mesh.vertices.tobytes()
