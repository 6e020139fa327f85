from collections.abc import Iterator

import numpy as np
import pytest

from quadpatch.colours.surroundings import Surroundings
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.measures import edge_statistics
from quadpatch.options import RepairOptions
from quadpatch.recipes.default import inpaint
from tests.quadpatch.shapes import bumpy_plate, on_surface, punched

PLATE = bumpy_plate(300, 2.0)


@pytest.fixture(scope="module", autouse=True)
def few_sites() -> Iterator[None]:
    """Calibrate at few places, so that they are a small part of a small scan."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("quadpatch.colours.surroundings.MAX_HOLES", 4)
        yield


@pytest.fixture(scope="module")
def filled() -> FilledMesh:
    return inpaint(
        punched(PLATE, *on_surface(PLATE, (0.51, 0.4), (-0.6, -0.5)), radius=0.022), None, RepairOptions()
    ).filled


def surroundings(filled: FilledMesh) -> Surroundings:
    return Surroundings.of_fills(filled, edge_statistics(filled.measured), np.random.default_rng(0))


def test_what_lies_around_small_holes_is_a_small_part_of_a_scan(filled: FilledMesh) -> None:
    part = surroundings(filled)
    assert len(part.filled.mesh.triangles) < 0.3 * len(filled.mesh.triangles)


def test_the_part_has_all_new_vertices_and_triangles_in_their_order(filled: FilledMesh) -> None:
    part, n = surroundings(filled), filled.n_measured_vertices
    assert (part.region.vertices[part.filled.n_measured_vertices :] == np.arange(n, len(filled.mesh.vertices))).all()
    new = part.region.vertices[part.filled.mesh.triangles[part.filled.n_measured_triangles :]]
    assert (new == filled.mesh.triangles[filled.n_measured_triangles :]).all()
    assert len(part.filled.vertex_hole) == len(part.filled.mesh.vertices) - part.filled.n_measured_vertices


def test_positions_of_the_part_are_those_of_the_scan(filled: FilledMesh) -> None:
    part = surroundings(filled)
    assert (part.filled.mesh.vertices == filled.mesh.vertices[part.region.vertices]).all()


def test_without_room_for_all_places_the_whole_is_taken() -> None:
    small = bumpy_plate(40, 2.0)
    whole = inpaint(punched(small, *on_surface(small, (0.0, 0.0)), radius=0.2), None, RepairOptions()).filled
    assert surroundings(whole).filled is whole


def test_without_fills_the_whole_is_taken(filled: FilledMesh) -> None:
    nothing = filled.without(np.arange(2))
    assert surroundings(nothing).filled is nothing
