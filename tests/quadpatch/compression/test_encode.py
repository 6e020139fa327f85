"""Whole meshes through the encoder and back.

Tests `quadpatch.compression.candidate`, `quadpatch.compression.guarantee`, `quadpatch.compression.decoded_surface` and
`quadpatch.compression.kept_vertices` as well.
"""

import numpy as np
import pytest

from quadpatch.compression.candidate import DictionaryChoice
from quadpatch.compression.content import COSINE, SELF
from quadpatch.compression.decode import decode_mesh
from quadpatch.compression.encode import EncodeOptions, encode_mesh
from quadpatch.compression.proof import deviation, sample
from quadpatch.errors import OptionError
from quadpatch.options import PatchOptions
from quadpatch.stages import Stages
from quadpatch.types import TriangleMesh
from tests.quadpatch.compression.encoded import encoded, max_error_of, surface
from tests.quadpatch.shapes import joined, moved, open_grid, sphere

NO_MODEL = None


def decoded(data: bytes) -> TriangleMesh:
    return decode_mesh(data, NO_MODEL).mesh  # type: ignore[arg-type]


def distances(mesh: TriangleMesh, data: bytes, spacing: float) -> tuple[float, float]:
    found = decoded(data)
    return deviation(sample(mesh, spacing), found).largest, deviation(sample(found, spacing), mesh).largest


@pytest.mark.parametrize("kind", [COSINE, SELF])
@pytest.mark.parametrize("name", ["sphere", "relief"])
def test_each_surface_lies_within_the_promised_error_of_the_other(name: str, kind: str) -> None:
    encoding, mesh = encoded(name, kind=kind), surface(name)
    assert max(distances(mesh, encoding.data, encoding.spacing)) <= max_error_of(mesh) * (1 + 1e-9)


def test_a_sphere_takes_less_than_a_hundredth_of_its_binary_form() -> None:
    mesh = surface("sphere")
    assert 100 * len(encoded("sphere").data) < 12 * len(mesh.vertices) + 12 * len(mesh.triangles) + 100 * 300


def test_same_mesh_and_options_give_the_same_bytes() -> None:
    mesh = surface("sphere")
    again = encode_mesh(mesh, DictionaryChoice((COSINE,)), EncodeOptions(max_error_of(mesh)), Stages())
    assert again.data == encoded("sphere").data


@pytest.mark.parametrize("name", ["sphere", "relief"])
def test_kept_connectivity_brings_triangles_back_bit_for_bit_and_vertices_in_order(name: str) -> None:
    mesh, found = surface(name), decoded(encoded(name, keep_connectivity=True).data)
    assert (found.triangles == mesh.triangles).all()
    assert np.linalg.norm(found.vertices - mesh.vertices, axis=1).max() <= max_error_of(mesh)


def test_the_grid_over_the_quads_of_a_closed_surface_has_no_crack() -> None:
    found = decoded(encoded("sphere").data)
    edges = np.sort(found.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()


def test_a_smaller_error_takes_more_bytes() -> None:
    mesh = surface("sphere")
    finer = encode_mesh(mesh, DictionaryChoice((COSINE,)), EncodeOptions(max_error_of(mesh) / 4), Stages())
    assert len(finer.data) > len(encoded("sphere").data)
    assert max(distances(mesh, finer.data, finer.spacing)) <= max_error_of(mesh) / 4 * (1 + 1e-9)


def crossing_sheets() -> TriangleMesh:
    """Three sheets that meet along one edge: every edge there has four faces."""
    flat = open_grid(9, width=2.0)
    upright = TriangleMesh(flat.vertices[:, [0, 2, 1]], flat.triangles)
    mesh = joined(flat, upright)
    places, index = np.unique(np.round(mesh.vertices, 9), axis=0, return_inverse=True)
    return TriangleMesh(places, index[mesh.triangles])


def thin_wall() -> TriangleMesh:
    """A flattened sphere, thinner than the promised error would let heights tell its sides apart."""
    ball = sphere(3)
    return TriangleMesh(ball.vertices * [1.0, 1.0, 0.01], ball.triangles)


@pytest.mark.parametrize(
    "mesh",
    [crossing_sheets(), thin_wall(), joined(sphere(2), moved(sphere(2), (3.0, 0.0, 0.0))), open_grid(6)],
    ids=["non-manifold", "thin wall", "two pieces", "open"],
)
def test_surfaces_that_are_no_height_map_keep_the_promise_too(mesh: TriangleMesh) -> None:
    error = max_error_of(mesh)
    encoding = encode_mesh(mesh, DictionaryChoice((COSINE,)), EncodeOptions(error), Stages())
    assert max(distances(mesh, encoding.data, encoding.spacing)) <= error * (1 + 1e-9)


def test_the_side_of_quads_and_their_cells_can_be_given() -> None:
    mesh = surface("relief")
    options = EncodeOptions(max_error_of(mesh), patches=PatchOptions(length=0.5, resolution=8))
    content = encode_mesh(mesh, DictionaryChoice((COSINE,)), options, Stages()).content
    assert content.levels == 3
    assert 8 <= len(content.walk.polygons) <= 32


@pytest.mark.parametrize("error", [0.0, -1.0, float("nan"), float("inf"), True])
def test_an_error_that_is_no_length_is_refused(error: float) -> None:
    with pytest.raises(OptionError, match="max_error"):
        EncodeOptions(error)


@pytest.mark.parametrize("factor", [1e-8, 0.5])
def test_an_error_that_does_not_fit_the_mesh_is_refused(factor: float) -> None:
    with pytest.raises(OptionError, match="must lie between"):
        encode_mesh(sphere(2), DictionaryChoice((COSINE,)), EncodeOptions(factor * 3.46), Stages())


def test_options_are_built_from_plain_values() -> None:
    assert EncodeOptions.from_dict({"max_error": 0.1, "patches": {"length": 2.0}}).patches.length == 2.0
    for wrong in ({"max_error": 0.1, "unknown": 1}, {}, {"max_error": 0.1, "patches": {"overlap": 2}}):
        with pytest.raises(OptionError):
            EncodeOptions.from_dict(wrong)


def test_a_single_triangle_can_be_encoded() -> None:
    mesh = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    encoding = encode_mesh(mesh, DictionaryChoice((COSINE,)), EncodeOptions(0.01), Stages())
    assert max(distances(mesh, encoding.data, encoding.spacing)) <= 0.01
