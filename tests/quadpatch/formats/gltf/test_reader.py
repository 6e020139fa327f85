"""glTF scenes read as one mesh.

Also tests `quadpatch.formats.gltf.accessors`, `quadpatch.formats.gltf.container`,
`quadpatch.formats.gltf.primitive` and `quadpatch.formats.gltf.scene`.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from quadpatch.errors import (
    CoordinateRangeError,
    EmptyMeshError,
    FormatError,
    IndexRangeError,
    NotFiniteError,
    ReadError,
    TooLargeError,
)
from quadpatch.formats.gltf import reader
from quadpatch.formats.gltf.reader import read_gltf
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.scan import Scan
from tests.quadpatch.formats.gltf.documents import as_gltf, glb, quarter_turn, scene

VERTICES = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
TRIANGLES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3]])


def read(document: dict[str, Any], binary: bytes, folder: Path | None = None) -> Scan:
    return read_gltf(glb(document, binary), ReadLimits(), folder)


def test_a_scene_is_read_in_metres_with_its_nodes_applied() -> None:
    nodes = ({"mesh": 0}, {"mesh": 0, "translation": [5, 0, 0], "scale": [2, 2, 2], "rotation": quarter_turn()})
    scan = read(*scene(VERTICES, TRIANGLES, *nodes))
    assert scan.unit == "meter"
    assert scan.vertices[:4].tobytes() == VERTICES.tobytes()
    expected = [[5, 0, 0], [7, 0, 0], [5, 0, 2], [5, -2, 0]]
    assert np.abs(scan.vertices[4:] - expected).max() < 1e-12
    assert scan.triangles.tolist() == [*TRIANGLES.tolist(), *(TRIANGLES + 4).tolist()]


def test_a_node_that_mirrors_turns_triangles_so_that_they_face_outwards() -> None:
    scan = read(*scene(VERTICES, TRIANGLES, {"mesh": 0, "scale": [-1, 1, 1]}))
    assert scan.vertices[1].tolist() == [-1, 0, 0]
    assert scan.triangles.tolist() == TRIANGLES[:, [0, 2, 1]].tolist()


def test_children_are_placed_by_their_parents() -> None:
    nodes = ({"children": [1], "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 9, 1]}, {"mesh": 0})
    document, binary = scene(VERTICES, TRIANGLES, *nodes)
    document["scenes"] = [{"nodes": [0]}]
    assert read(document, binary).vertices[3].tolist() == [0, 0, 11]


def test_buffers_may_stand_in_the_document() -> None:
    document, binary = scene(VERTICES, TRIANGLES, {"mesh": 0})
    scan = read_gltf(as_gltf(document, binary), ReadLimits())
    assert scan.format == "gltf"
    assert scan.vertices.tobytes() == VERTICES.tobytes()


@pytest.mark.parametrize(("mode", "expected"), [(5, [[0, 1, 2], [2, 1, 3]]), (6, [[0, 1, 2], [0, 2, 3]])])
def test_strips_and_fans_become_triangles(mode: int, expected: list[list[int]]) -> None:
    document, binary = scene(VERTICES, np.arange(4), {"mesh": 0})
    document["meshes"][0]["primitives"][0]["mode"] = mode
    assert read(document, binary).triangles.tolist() == expected


def test_lines_beside_triangles_are_left_out() -> None:
    document, binary = scene(VERTICES, TRIANGLES, {"mesh": 0})
    primitive = document["meshes"][0]["primitives"][0]
    document["meshes"][0]["primitives"].append({**primitive, "mode": 1})
    assert len(read(document, binary).triangles) == 3


def test_sparse_accessors_replace_rows() -> None:
    document, binary = scene(VERTICES, TRIANGLES, {"mesh": 0})
    document["bufferViews"] += [
        {"buffer": 0, "byteOffset": len(binary), "byteLength": 2},
        {"buffer": 0, "byteOffset": len(binary) + 2, "byteLength": 12},
    ]
    binary += np.array([3], "<u2").tobytes() + np.array([7, 8, 9], "<f4").tobytes()
    indices = {"bufferView": 2, "componentType": 5123}
    document["accessors"][0]["sparse"] = {"count": 1, "indices": indices, "values": {"bufferView": 3}}
    assert read(document, binary).vertices[3].tolist() == [7, 8, 9]


def test_a_buffer_beside_the_mesh_is_read_and_one_outside_is_not(tmp_path: Path) -> None:
    document, binary = scene(VERTICES, TRIANGLES, {"mesh": 0})
    (tmp_path / "scan").mkdir()
    (tmp_path / "scan" / "a b.bin").write_bytes(binary)
    (tmp_path / "outside.bin").write_bytes(binary)
    (tmp_path / "scan" / "link.bin").symlink_to(tmp_path / "outside.bin")
    document["buffers"][0]["uri"] = "a%20b.bin"
    assert len(read(document, b"", tmp_path / "scan").triangles) == 3
    wrong = ["../outside.bin", "link.bin", str(tmp_path / "outside.bin"), "file:///etc/passwd", "none.bin"]
    for uri in [*wrong, "http://example.invalid/a.bin", "//example.invalid/a.bin", "\0", "a" * 5000]:
        document["buffers"][0]["uri"] = uri
        with pytest.raises(ReadError):
            read(document, b"", tmp_path / "scan")
    document["buffers"][0]["uri"] = "a%20b.bin"
    with pytest.raises(ReadError, match=r"send a \.glb"):
        read(document, b"")


def damaged(change: str) -> tuple[dict[str, Any], bytes]:
    document, binary = scene(VERTICES, TRIANGLES, {"mesh": 0})
    scope: dict[str, Any] = {"d": document, "a": document["accessors"], "p": document["meshes"][0]["primitives"][0]}
    exec(change, scope)
    return document, binary


@pytest.mark.parametrize(
    ("change", "error"),
    [
        ("d['asset']['version'] = '1.0'", FormatError),
        ("d['extensionsRequired'] = ['KHR_draco_mesh_compression']", FormatError),
        ("d['extensionsRequired'] = ['EXT_meshopt_compression']", FormatError),
        ("p['extensions'] = {'KHR_draco_mesh_compression': {}}", FormatError),
        ("d['bufferViews'][0]['extensions'] = {'EXT_meshopt_compression': {}}", FormatError),
        ("d['nodes'] = [{'children': [0], 'mesh': 0}]", ReadError),
        ("d['nodes'] = [{'mesh': 0, 'children': [1, 1]}, {}]", ReadError),
        ("d['nodes'] = []", ReadError),
        ("d['nodes'] = {}", ReadError),
        ("d['nodes'][0]['mesh'] = 1", ReadError),
        ("d['nodes'][0]['mesh'] = True", ReadError),
        ("d['nodes'][0]['scale'] = [1, 2]", ReadError),
        ("d['nodes'][0]['scale'] = ['1', 2, 3]", ReadError),
        ("d['nodes'][0]['scale'] = [1e200, 1e200, 1e200]", CoordinateRangeError),
        ("d['scenes'] = [{}]", EmptyMeshError),
        ("p['mode'] = 0", EmptyMeshError),
        ("p['attributes'] = {}", ReadError),
        ("p['attributes'] = []", ReadError),
        ("p['indices'] = 0", ReadError),
        ("p['indices'] = -1", ReadError),
        ("a[0]['count'] = 10**9", TooLargeError),
        ("a[0]['count'] = 1000", ReadError),
        ("a[0]['count'] = -1", ReadError),
        ("a[0]['count'] = 3.5", ReadError),
        ("a[0]['count'] = 3", IndexRangeError),
        ("a[0]['type'] = 'VEC2'", ReadError),
        ("a[0]['componentType'] = 1", ReadError),
        ("a[0]['bufferView'] = 99", ReadError),
        ("a[0]['byteOffset'] = 10**15", ReadError),
        ("a[1]['count'] = 8", ReadError),
        ("d['bufferViews'][0]['byteStride'] = 4", ReadError),
        ("d['bufferViews'][0]['byteOffset'] = 60", ReadError),
        ("d['bufferViews'][0]['buffer'] = 3", ReadError),
        ("d['buffers'] = 3", ReadError),
        ("d['buffers'][0]['uri'] = 'data:;base64,???'", ReadError),
        ("a[0]['sparse'] = {'count': 9}", ReadError),
        ("d['meshes'][0]['primitives'] = [3]", ReadError),
    ],
)
def test_wrong_documents_are_refused(change: str, error: type[Exception]) -> None:
    with pytest.raises(error):
        read(*damaged(change))


def test_infinite_positions_are_refused() -> None:
    vertices = VERTICES.copy()
    vertices[2, 1] = np.inf
    with pytest.raises(NotFiniteError):
        read(*scene(vertices, TRIANGLES, {"mesh": 0}))


def test_a_small_mesh_placed_often_is_too_large() -> None:
    document, binary = scene(VERTICES, TRIANGLES, *[{"mesh": 0}] * 100)
    with pytest.raises(TooLargeError):
        read_gltf(glb(document, binary), ReadLimits(max_vertices=399))


def test_a_mesh_is_read_once_however_often_it_is_placed(monkeypatch: pytest.MonkeyPatch) -> None:
    indices: list[object] = []

    def counted(file: Any, index: object, limits: ReadLimits) -> Any:
        indices.append(index)
        return read_mesh(file, index, limits)

    read_mesh = reader._read_mesh
    monkeypatch.setattr(reader, "_read_mesh", counted)
    scan = read(*scene(VERTICES, TRIANGLES, *[{"mesh": 0, "translation": [5.0 * i, 0, 0]} for i in range(50)]))
    assert indices == [0]
    np.testing.assert_array_equal(scan.vertices[-4:], VERTICES + np.array([245.0, 0, 0]))


@pytest.mark.parametrize("text", [b"[]", b"{", b'{"a": NaN}', b'{"a": 1e999}', b"[" * 100_000, b"\xff\xff", b"3"])
def test_documents_that_are_no_json_objects_are_refused(text: bytes) -> None:
    with pytest.raises(ReadError):
        read_gltf(text, ReadLimits())
