import json
from typing import Any

import numpy as np

from quadpatch.formats.gltf.accessors import read_accessor
from quadpatch.formats.gltf.container import GltfFile, load_gltf
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.reading import read_bytes
from quadpatch.types import FloatArray, TriangleMesh
from quadpatch.views.glb import Part, encode_parts
from tests.quadpatch.shapes import moved, open_grid, sphere

FAR = (500_000.0, 5_000_000.0, 300.0)


def loaded(data: bytes) -> GltfFile:
    return load_gltf(data, None, ReadLimits())


def extras(file: GltfFile) -> dict[str, Any]:
    found: dict[str, Any] = file.document["scenes"][0]["extras"]
    return found


def attribute(file: GltfFile, part: int, name: str) -> FloatArray:
    index = file.document["meshes"][part]["primitives"][0]["attributes"][name]
    return np.asarray(read_accessor(file, index, (1, 3, 4), ReadLimits()), np.float64)


def test_positions_are_exact_about_an_origin_far_away() -> None:
    mesh = moved(sphere(3), FAR)
    data = encode_parts([Part("measured", mesh)], np.array(FAR), {"level": "coarse"})
    file = loaded(data)
    origin = np.array(extras(file)["origin"])
    assert np.abs(attribute(file, 0, "POSITION") + origin - mesh.vertices).max() < 1e-6
    assert extras(file)["level"] == "coarse"
    assert len(read_bytes(data, "glb", ReadLimits()).triangles) == len(mesh.triangles)


def test_normals_are_unit_vectors_of_the_surface_within_a_byte() -> None:
    ball = sphere(4)
    normals = attribute(loaded(encode_parts([Part("measured", ball)], np.zeros(3), {})), 0, "NORMAL")
    assert np.abs(normals - ball.vertices).max() < 0.02


def test_both_parts_have_one_normal_on_their_seam() -> None:
    ball = sphere(4)
    upper = ball.vertices[ball.triangles][..., 2].max(axis=1) > 0.5
    parts = [
        Part(name, TriangleMesh(ball.vertices, ball.triangles[chosen]))
        for name, chosen in (("measured", ~upper), ("invented", upper))
    ]
    file = loaded(encode_parts(parts, np.zeros(3), {}))
    below, above = (np.unique(part.mesh.triangles) for part in parts)
    seam = np.intersect1d(below, above)
    assert len(seam) > 20
    assert np.array_equal(attribute(file, 0, "NORMAL")[seam], attribute(file, 1, "NORMAL")[seam])
    assert [node["name"] for node in file.document["nodes"]] == ["measured", "invented"]


def test_colours_and_values_come_back_and_their_ranges_are_told() -> None:
    plate = open_grid(5)
    colours = np.linspace(0, 1, 75).reshape(25, 3)
    values = np.linspace(-1, 3, 25)
    file = loaded(encode_parts([Part("measured", plate, colours, {"_CONFIDENCE": values})], np.zeros(3), {}))
    assert np.abs(attribute(file, 0, "COLOR_0")[:, :3] - colours).max() < 1e-4
    assert (attribute(file, 0, "COLOR_0")[:, 3] == 1).all()
    assert np.allclose(attribute(file, 0, "_CONFIDENCE")[:, 0], values)
    assert extras(file)["ranges"] == {"_CONFIDENCE": [-1.0, 3.0]}


def test_a_part_without_triangles_is_left_out() -> None:
    empty = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64))
    file = loaded(encode_parts([Part("measured", open_grid(3)), Part("invented", empty)], np.zeros(3), {}))
    assert len(file.document["meshes"]) == 1


def test_indices_are_short_where_they_can_be() -> None:
    small, large = (encode_parts([Part("measured", open_grid(n))], np.zeros(3), {}) for n in (250, 260))
    kinds = [loaded(data).document["accessors"][-1]["componentType"] for data in (small, large)]
    assert kinds == [5123, 5125]
    assert json.dumps(loaded(small).document["extensionsRequired"]) == '["KHR_mesh_quantization"]'
