"""glTF in, glTF out: the document stays, and the fill is a child of the node that has the hole."""

import io
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import trimesh

from quadpatch.formats.gltf.reader import read_gltf
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.scan import Scan
from tests.quadpatch.formats.fills import EMPTY, appended, as_scan, cap_holes, n_open_edges
from tests.quadpatch.formats.gltf.documents import as_gltf, chunks, glb, quarter_turn, scene
from tests.quadpatch.shapes import punched, sphere

TURNED = {"mesh": 0, "translation": [4.1, 0.3, 0], "rotation": quarter_turn(), "scale": [1.7, 1.7, 1.7]}


def read(data: bytes) -> Scan:
    return read_gltf(data, ReadLimits())


def append(scan: Scan) -> bytes:
    return appended(scan, cap_holes(scan))


def ball() -> Scan:
    return as_scan(punched(sphere(2), (0, 0, 1), radius=0.5))


@pytest.mark.parametrize("node", [{"mesh": 0}, TURNED, {"mesh": 0, "scale": [-1, 2, 1]}])
@pytest.mark.parametrize("pack", [glb, as_gltf])
def test_holes_are_closed_bit_for_bit_whatever_the_node_does(node: dict[str, Any], pack: Callable[..., bytes]) -> None:
    mesh = ball()
    scan = read(pack(*scene(mesh.vertices, mesh.triangles, node)))
    again = read(append(scan))
    assert again.vertices[: len(scan.vertices)].tobytes() == scan.vertices.tobytes()
    assert again.triangles[: len(scan.triangles)].tolist() == scan.triangles.tolist()
    assert n_open_edges(scan) > 0
    assert n_open_edges(again) == 0
    # Closed and turned outwards: the volume is that of the ball.
    a, b, c = np.moveaxis(again.vertices[again.triangles], 1, 0)
    a0, b0, c0 = np.moveaxis(scan.vertices[scan.triangles], 1, 0)
    volume = np.einsum("ij,ij->", np.cross(a, b), c)
    assert volume > np.einsum("ij,ij->", np.cross(a0, b0), c0) > 0


def test_two_places_of_one_mesh_are_filled_each_at_its_place() -> None:
    mesh = ball()
    scan = read(glb(*scene(mesh.vertices, mesh.triangles, {"mesh": 0}, TURNED)))
    data = append(scan)
    assert n_open_edges(read(data)) == 0
    document, _ = chunks(data)
    assert [node.get("children") for node in document["nodes"][:2]] == [[2], [3]]
    assert {mesh["name"] for mesh in document["meshes"][1:]} == {"quadpatch_filled"}


def test_the_document_and_its_buffer_stay() -> None:
    mesh = ball()
    old, binary = scene(mesh.vertices, mesh.triangles, {"mesh": 0})
    new, longer = chunks(append(read(glb(old, binary))))
    assert longer.startswith(binary)
    for key in ("asset", "scenes", "materials"):
        assert new[key] == old[key]
    for key in ("accessors", "bufferViews", "meshes"):
        assert new[key][: len(old[key])] == old[key]
    assert new["meshes"][1]["primitives"][0]["material"] == 0


def test_an_empty_fill_changes_no_entry() -> None:
    mesh = ball()
    old, binary = scene(mesh.vertices, mesh.triangles, {"mesh": 0})
    scan = read(glb(old, binary))
    assert scan.source is not None
    assert chunks(appended(scan, EMPTY)) == chunks(glb(old, binary))


def test_normals_colours_and_texture_go_along_and_marks_tell_hole_and_confidence() -> None:
    mesh = ball()
    half = (mesh.vertices[:, :1] > 0).astype(float)
    colours = np.concatenate([half, 1 - half, 0 * half, 1 + 0 * half], axis=1)
    more = {"NORMAL": mesh.vertices, "COLOR_0": colours, "TEXCOORD_0": 0.5 + mesh.vertices[:, :2] / 4}
    data = append(read(glb(*scene(mesh.vertices, mesh.triangles, {"mesh": 0}, more=more))))
    loaded = trimesh.load(io.BytesIO(data), file_type="glb", process=False)
    filled = next(geometry for name, geometry in loaded.geometry.items() if "filled" in name)
    assert filled.vertex_normals[:, 2].min() > 0.5
    again = read(data)
    assert again.source is not None
    looks = again.source.vertex_attributes(again)
    new = slice(len(mesh.vertices), None)
    assert looks.colours is not None
    assert looks.normals is not None
    assert looks.texture is not None
    assert looks.colours[new, 3].tolist() == [255.0] * len(looks.colours[new])
    assert np.allclose(looks.colours[new, 0] + looks.colours[new, 1], 255.0, atol=1e-3)
    assert 0 < looks.colours[new, 0].mean() < 255
    assert np.allclose(np.linalg.norm(looks.normals, axis=1), 1.0, atol=1e-6)
    rim = looks.texture[: len(mesh.triangles)]
    assert (looks.texture[len(mesh.triangles) :] >= rim.min(axis=(0, 1)) - 1e-6).all()
    attributes = chunks(data)[0]["meshes"][1]["primitives"][0]["attributes"]
    assert set(attributes) == {"POSITION", "NORMAL", "COLOR_0", "TEXCOORD_0", "_HOLE_ID", "_CONFIDENCE"}


def test_buffers_from_files_become_part_of_the_result() -> None:
    mesh = ball()
    data = append(read(as_gltf(*scene(mesh.vertices, mesh.triangles, {"mesh": 0}))))
    assert n_open_edges(read(data)) == 0
    assert data.count(b"base64,") == 2
