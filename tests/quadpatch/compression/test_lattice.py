import numpy as np
import pytest

from quadpatch.compression.connectivity import encode_polygons
from quadpatch.compression.lattice import LARGEST, from_lattice, places_of, residuals, to_lattice
from quadpatch.errors import ReadError
from tests.quadpatch.shapes import sphere


def test_a_place_is_at_most_half_a_step_off_along_each_axis() -> None:
    vertices = sphere(2).vertices
    origin = vertices.min(axis=0)
    found = from_lattice(to_lattice(vertices, origin, 0.01), origin, 0.01)
    assert np.abs(found - vertices).max() <= 0.005 * (1 + 1e-9)


def test_places_come_back_from_their_differences() -> None:
    walk, _, vertex = encode_polygons(sphere(2).triangles)
    places = to_lattice(sphere(2).vertices[vertex], np.zeros(3), 1e-3)
    differences = residuals(places, walk.predictors)
    assert (places_of(differences, walk.predictors) == places).all()
    assert np.abs(differences[3:]).mean() < 0.5 * np.abs(places[3:]).mean()


def test_places_that_grow_beyond_the_lattice_are_refused() -> None:
    with pytest.raises(ReadError, match="beyond the lattice"):
        places_of(np.array([[LARGEST - 1, 0, 0], [1, 0, 0]]), [(-1, -1, -1), (0, 0, 0)])
