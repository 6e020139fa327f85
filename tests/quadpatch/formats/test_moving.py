"""Files handed back with vertices at other positions.

Also tests `quadpatch.formats.moved_normals`, `quadpatch.formats.words`, `quadpatch.formats.ply.moved_rows`,
`quadpatch.formats.gltf.moved_scene`, `quadpatch.formats.gltf.moved_arrays` and
`quadpatch.formats.threemf.moved_vertices`.
"""

import io
import json
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.errors import CoordinateRangeError, FormatError, NotFiniteError
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.moving import write_moved
from quadpatch.formats.ply.reader import PlySource, read_ply
from quadpatch.formats.reading import read_bytes, read_scan
from quadpatch.formats.scan import Moved, Scan
from quadpatch.formats.writing import write_scan
from quadpatch.types import BoolArray, FloatArray
from tests.quadpatch.formats.fills import EMPTY, as_scan
from tests.quadpatch.formats.gltf import documents
from tests.quadpatch.formats.ply.builder import Ply, ply_files
from tests.quadpatch.formats.test_conversion import FORMATS, textured_ball
from tests.quadpatch.formats.threemf import packages
from tests.quadpatch.shapes import punched, sphere

BALL = as_scan(sphere(2))


def some_moved(scan: Scan, seed: int = 0) -> tuple[Moved, BoolArray]:
    """Move every third position, all vertices at one of them alike, by amounts that float32 holds."""
    _, place = np.unique(scan.vertices, axis=0, return_inverse=True)
    shift = np.random.default_rng(seed).integers(-64, 64, (place.max() + 1, 3)) / 4096
    shift[np.arange(len(shift)) % 3 != 0] = 0
    vertices = (scan.vertices + shift[place.reshape(-1)]).astype(np.float32).astype(np.float64)
    is_shifted = np.asarray(shift[place.reshape(-1)].any(axis=1))
    vertices = np.where(is_shifted[:, np.newaxis], vertices, scan.vertices)
    moved = Moved(vertices)
    return moved, moved.is_moved(scan)


def file_of(suffix: str, folder: Path) -> Path:
    """Write a ball with whatever the format can hold besides it."""
    path = folder / f"in.{suffix}"
    write_scan(path, textured_ball(), EMPTY)
    return path


def write(scan: Scan, moved: Moved, folder: Path, suffix: str = "") -> tuple[bytes, list[str]]:
    path = folder / f"out.{suffix or scan.format}"
    warnings = write_moved(path, scan, moved)
    return path.read_bytes(), warnings


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_file_of_which_nothing_moves_keeps_every_byte(suffix: str, tmp_path: Path) -> None:
    path = file_of(suffix, tmp_path)
    scan = read_scan(path)
    data, warnings = write(scan, Moved(scan.vertices.copy()), tmp_path)
    assert data == path.read_bytes()
    assert warnings == []


@pytest.mark.parametrize("suffix", FORMATS)
def test_what_moves_is_where_it_should_be_and_what_stays_keeps_its_bits(suffix: str, tmp_path: Path) -> None:
    scan = read_scan(file_of(suffix, tmp_path))
    moved, is_moved = some_moved(scan)
    data, _ = write(scan, moved, tmp_path)
    again = read_bytes(data, suffix, ReadLimits())
    assert 0 < is_moved.sum() < len(is_moved)
    assert again.vertices.tobytes() == moved.vertices.tobytes()
    assert again.triangles.tobytes() == scan.triangles.tobytes()


@pytest.mark.parametrize("suffix", ["ply", "obj", "off", "glb", "gltf", "3mf"])
def test_colours_and_texture_stay_as_they_were(suffix: str, tmp_path: Path) -> None:
    scan = read_scan(file_of(suffix, tmp_path))
    data, _ = write(scan, some_moved(scan)[0], tmp_path)
    again = read_bytes(data, suffix, ReadLimits())
    assert scan.source is not None
    assert again.source is not None
    before, after = scan.source.vertex_attributes(scan), again.source.vertex_attributes(again)
    for old, new in ((before.colours, after.colours), (before.texture, after.texture)):
        assert (old is None) == (new is None)
        assert old is None or (new is not None and old.tobytes() == new.tobytes())


@pytest.mark.parametrize("suffix", ["ply", "obj", "glb", "gltf"])
def test_normals_of_what_moved_are_those_of_the_new_surface(suffix: str, tmp_path: Path) -> None:
    scan = read_scan(file_of(suffix, tmp_path))
    # Half of the ball is stretched: its normals are those of an ellipsoid.
    upper = scan.vertices[:, 0] > 0
    vertices = scan.vertices * np.where(upper, 2.0, 1.0)[:, np.newaxis] ** [1, 0, 0]
    data, warnings = write(scan, Moved(vertices), tmp_path)
    again = read_bytes(data, suffix, ReadLimits())
    old, new = normals(scan), normals(again)
    is_moved = Moved(vertices).is_moved(scan)
    assert warnings == [f"the stored normals of {int(is_moved.sum()):,} vertices that moved are computed anew"]
    assert new[~is_moved].tobytes() == old[~is_moved].tobytes()
    exact = vertices / [4, 1, 1]
    exact /= np.linalg.norm(exact, axis=1, keepdims=True)
    inside = upper & (scan.vertices[:, 0] > 0.4) & (scan.vertices[:, 2] < 0.4)
    assert np.einsum("ij,ij->i", new, exact)[inside].min() > 0.98
    assert np.einsum("ij,ij->i", old, exact)[inside].min() < 0.95


def normals(scan: Scan) -> FloatArray:
    assert scan.source is not None
    found = scan.source.vertex_attributes(scan).normals
    assert found is not None
    return found


def test_a_crease_stays_a_crease_and_a_seam_stays_smooth(tmp_path: Path) -> None:
    # Two squares that meet at a right angle: the edge has a normal of each side. The left one has a seam besides.
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (1, 0, 0), (1, 0, 1), (1, 1, 1), (1, 1, 0), (0, 0, 0)]
    sides = [(0, 0, 1)] * 4 + [(-1, 0, 0)] * 4 + [(0, 0, 1)]
    rows = [" ".join(map(str, (*point, *side))) for point, side in zip(points, sides, strict=True)]
    faces = ["3 0 1 2", "3 8 2 3", "3 4 5 6", "3 4 6 7"]
    head = "ply\nformat ascii 1.0\nelement vertex 9\n"
    head += "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    head += "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    scan = read_ply((head + "\n".join([*rows, *faces, ""])).encode(), ReadLimits())
    lifted = scan.vertices + np.array([0, 0, 1.0]) * (scan.vertices[:, :1] == 0)
    data, _ = write(scan, Moved(lifted), tmp_path)
    new = normals(read_bytes(data, "ply", ReadLimits()))
    assert new[4:8].tolist() == [[-1, 0, 0]] * 4
    assert new[0].tolist() == new[8].tolist()
    assert new[0] == pytest.approx(np.array([1, 0, 1]) / np.sqrt(2), abs=1e-6)
    # The other end of the crease did not move.
    assert new[1].tolist() == [0, 0, 1]


@given(made=ply_files(), data=st.data())
def test_only_the_numbers_of_moved_vertices_change_in_a_ply(
    made: tuple[Ply, list[list[float]], list[list[int]]], data: st.DataObject
) -> None:
    ply, vertices, _ = made
    raw = ply.encode()
    scan = read_ply(raw, ReadLimits())
    assert isinstance(scan.source, PlySource)
    assert scan.source.move(scan, Moved(scan.vertices.copy())) == raw
    chosen = data.draw(st.lists(st.integers(0, len(vertices) - 1), unique=True))
    positions = scan.vertices.copy()
    # So few digits are the same word as float32 and as float64.
    positions[chosen] = np.trunc(positions[chosen]) + 0.25
    # The same file, written with these numbers from the start.
    for name, _, props in ply.elements:
        for prop in props if name == "vertex" else []:
            if prop.name in "xyz":
                prop.values = positions[:, "xyz".index(prop.name)].tolist()
    assert scan.source.move(scan, Moved(positions)) == ply.encode()


@given(made=ply_files(), data=st.data())
def test_properties_are_added_to_any_ply_and_replace_those_of_their_name(
    made: tuple[Ply, list[list[float]], list[list[int]]], data: st.DataObject
) -> None:
    ply, vertices, _ = made
    scan = read_ply(ply.encode(), ReadLimits())
    assert isinstance(scan.source, PlySource)
    kinds = st.sampled_from([np.float32, np.uint8, np.int32])
    names = data.draw(st.lists(st.sampled_from(["shift", "quality", "flags", "custom"]), unique=True, min_size=1))
    number = np.arange(len(vertices))
    properties = {name: (number + k).astype(data.draw(kinds)) for k, name in enumerate(names)}
    rows = scan.source.file.element("vertex")
    assert rows is not None
    if any(rows.list_column(name) is not None for name in names):
        with pytest.raises(FormatError, match="lists"):
            scan.source.move(scan, Moved(scan.vertices, properties))
        return
    again = read_ply(scan.source.move(scan, Moved(scan.vertices, properties)), ReadLimits())
    assert again.vertices.tobytes() == scan.vertices.tobytes()
    assert again.triangles.tobytes() == scan.triangles.tobytes()
    assert isinstance(again.source, PlySource)
    written = again.source.file.element("vertex")
    assert written is not None
    for name, values in properties.items():
        column = written.scalar(name)
        assert column is not None
        assert column.dtype.newbyteorder("=") == values.dtype
        assert column.tolist() == values.tolist()
    for prop in rows.element.properties:
        if prop.name not in names and rows.scalar(prop.name) is not None:
            assert str(written.scalar(prop.name)) == str(rows.scalar(prop.name))


TEXTS = {
    "ply": "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty double x\r\nproperty uchar red\r\n"
    "property double y\r\nproperty double z\r\nelement face 1\r\nproperty list uchar int vertex_indices\r\n"
    "end_header\r\n0.10  7 1e-3 0\r\n1.000000000000000001 8 0 0 \r\n\t0 9 1.50 0\r\n3 0 1 2",
    "obj": "# by hand\nmtllib a.mtl\nv 0.10  1e-3 0 # first\nv 1.000000000000000001 \\\n 0 0 0.5 0.5 0.5\nvt 0 0\n"
    "\tv\t0 1.50 0#last\nusemtl red # skin\nf 1/1 2/1 3/1\nl 1 2\n",
    "off": "OFF # by hand\n3 1 0\n\n0.10  1e-3 0 # first\n1.000000000000000001 0 0\n0 1.50 0\n3 0 1 2\n",
    "stl": "solid vertex 1 2 3\nfacet normal 0 0 0.0\nouter loop\nVERTEX 0.10  1e-3 0\n"
    " vertex 1.000000000000000001 0 0\nvertex 0 1.50 0 endloop\nendfacet\nendsolid vertex\n",
}


@pytest.mark.parametrize("suffix", TEXTS)
def test_text_changes_in_the_words_that_move_alone(suffix: str, tmp_path: Path) -> None:
    text = TEXTS[suffix]
    scan = read_bytes(text.encode(), suffix, ReadLimits())
    vertices = scan.vertices.copy()
    vertices[2, 1] = 1.0 / 3.0
    data, _ = write(scan, Moved(vertices), tmp_path)
    assert data.decode() == text.replace("1.50", "0.3333333333333333")
    assert read_bytes(data, suffix, ReadLimits()).vertices.tobytes() == vertices.tobytes()


@pytest.mark.parametrize("suffix", ["obj", "off"])
@pytest.mark.parametrize("codec", ["utf-8-sig", "utf-16", "utf-32"])
def test_text_keeps_its_encoding_and_its_mark(suffix: str, codec: str, tmp_path: Path) -> None:
    text = TEXTS[suffix].replace("by hand", "größe")
    scan = read_bytes(text.encode(codec), suffix, ReadLimits())
    assert write(scan, Moved(scan.vertices), tmp_path)[0] == text.encode(codec)
    vertices = scan.vertices + np.array([0, 0, 0.5])
    data, _ = write(scan, Moved(vertices), tmp_path)
    assert data.decode(codec).count("0.5") == text.count("0.5") + 3
    assert "größe" in data.decode(codec)


def test_facets_that_move_get_their_normal_anew_and_others_keep_theirs(tmp_path: Path) -> None:
    scan = read_scan(file_of("stl", tmp_path))
    moved, is_moved = some_moved(scan)
    before = np.frombuffer(
        (tmp_path / "in.stl").read_bytes()[84:], [("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]
    )
    after = np.frombuffer(write(scan, moved, tmp_path)[0][84:], before.dtype)
    changed = is_moved.reshape(-1, 3).any(axis=1)
    assert (after["n"][~changed] == before["n"][~changed]).all()
    corners = moved.vertices[scan.triangles]
    exact = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    exact /= np.linalg.norm(exact, axis=1, keepdims=True)
    assert np.abs(after["n"][changed] - exact[changed]).max() < 1e-6
    assert (after["n"][changed] != before["n"][changed]).any()


def test_ascii_facets_get_their_normal_anew(tmp_path: Path) -> None:
    text = TEXTS["stl"].replace("0 0 0.0", "0 0 1")
    scan = read_bytes(text.encode(), "stl", ReadLimits())
    data, _ = write(scan, Moved(scan.vertices[:, [2, 0, 1]]), tmp_path)
    assert b"facet normal 1.0 0 0.0\n" in data


def test_coordinates_are_written_in_the_type_of_the_file(tmp_path: Path) -> None:
    scan = read_scan(file_of("ply", tmp_path))
    assert isinstance(scan.source, PlySource)
    far = replace(scan, vertices=scan.vertices + 1e4)
    (tmp_path / "far").mkdir()
    write_scan(tmp_path / "far" / "in.stl", far, EMPTY)
    single = read_scan(tmp_path / "far" / "in.stl")
    third = Moved(single.vertices + 1 / 3)
    data, (warning,) = write(single, third, tmp_path)
    stored = read_bytes(data, "stl", ReadLimits()).vertices
    assert stored.tobytes() == third.vertices.astype(np.float32).astype(np.float64).tobytes()
    assert warning.startswith("coordinates are rounded to the numbers of the file, by up to 0.000")


def test_a_file_of_integers_is_written_anew_with_fractions(tmp_path: Path) -> None:
    text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty short x\nproperty short y\nproperty short z\n"
    text += "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n9 0 0\n0 9 0\n3 0 1 2\n"
    scan = read_ply(text.encode(), ReadLimits())
    data, (warning,) = write(scan, Moved(scan.vertices + 0.25), tmp_path)
    assert warning.startswith(
        "the mesh is written anew, without what its file held besides it: the numbers of the file"
    )
    assert (read_bytes(data, "ply", ReadLimits()).vertices == scan.vertices + 0.25).all()


@pytest.mark.parametrize("suffix", FORMATS)
@pytest.mark.parametrize("source", ["ply", "obj", "glb"])
def test_a_conversion_holds_the_moved_mesh(source: str, suffix: str, tmp_path: Path) -> None:
    scan = read_scan(file_of(source, tmp_path))
    moved, _ = some_moved(scan)
    again = read_bytes(write(scan, moved, tmp_path, suffix)[0], suffix, ReadLimits())
    wanted = moved.vertices[scan.triangles]
    if suffix in ("stl", "glb", "gltf"):
        wanted = wanted.astype(np.float32).astype(np.float64)
    assert again.vertices[again.triangles].tobytes() == wanted.tobytes()
    assert source == "obj" or b"quadpatch_filled" not in (tmp_path / f"out.{suffix}").read_bytes()


def test_properties_go_into_ply_and_are_named_where_they_are_lost(tmp_path: Path) -> None:
    scan = read_scan(file_of("off", tmp_path))
    properties = {"shift": np.arange(len(scan.vertices), dtype=np.float32), "restored": scan.vertices[:, 0] > 0}
    data, warnings = write(scan, Moved(scan.vertices, properties), tmp_path, "ply")
    again = read_bytes(data, "ply", ReadLimits())
    assert warnings == []
    assert isinstance(again.source, PlySource)
    rows = again.source.file.element("vertex")
    assert rows is not None
    assert [prop.name for prop in rows.element.properties[-2:]] == ["shift", "restored"]
    assert np.array_equal(np.asarray(rows.scalar("shift")), properties["shift"])
    assert np.array_equal(np.asarray(rows.scalar("restored")), properties["restored"])
    _, (warning,) = write(scan, Moved(scan.vertices, properties), tmp_path, "obj")
    assert warning == "obj has no place for numbers of vertices: shift, restored left out, which PLY keeps"


def missing_third(scan: Scan) -> Scan:
    vertices = scan.vertices.copy()
    vertices[::3] = np.nan
    return replace(scan, vertices=vertices)


@pytest.mark.parametrize("suffix", ["ply", "obj", "off"])
def test_missing_vertices_pass_where_they_are_allowed_and_are_filled_in(suffix: str, tmp_path: Path) -> None:
    whole = Scan(BALL.vertices, BALL.triangles, "memory")
    write_scan(tmp_path / f"in.{suffix}", missing_third(whole), EMPTY)
    with pytest.raises(NotFiniteError, match="infinite or NaN"):
        read_scan(tmp_path / f"in.{suffix}")
    scan = read_scan(tmp_path / f"in.{suffix}", allow_missing=True)
    assert np.isnan(scan.vertices[::3]).all()
    data, warnings = write(scan, Moved(whole.vertices), tmp_path)
    assert warnings == []
    assert read_bytes(data, suffix, ReadLimits()).vertices.tobytes() == whole.vertices.tobytes()
    # What stays missing keeps its bytes; other formats can't say so.
    assert write(scan, Moved(scan.vertices), tmp_path)[0] == (tmp_path / f"in.{suffix}").read_bytes()
    with pytest.raises(NotFiniteError, match="have no position"):
        write(scan, Moved(scan.vertices), tmp_path, "stl")


def test_vertices_may_not_get_lost_or_leave_the_range(tmp_path: Path) -> None:
    for number, error in ((np.nan, NotFiniteError), (np.inf, NotFiniteError), (1e19, CoordinateRangeError)):
        vertices = BALL.vertices.copy()
        vertices[5] = number
        with pytest.raises(error, match="vert"):
            write(BALL, Moved(vertices), tmp_path, "ply")
    assert list(tmp_path.iterdir()) == []


def placed_twice(mirror: float) -> tuple[dict[str, Any], bytes]:
    ball = as_scan(punched(sphere(1), (0, 0, 1), radius=0.5))
    nodes: list[dict[str, Any]] = [
        {"mesh": 0},
        {"mesh": 0, "translation": [8.0, 0.0, 0.0], "scale": [mirror, 1.0, 1.0]},
    ]
    more = {"NORMAL": ball.vertices, "COLOR_0": np.abs(ball.vertices)}
    document, binary = documents.scene(ball.vertices, ball.triangles, *nodes, more=more)
    document["accessors"][0] |= {"min": ball.vertices.min(axis=0).tolist(), "max": ball.vertices.max(axis=0).tolist()}
    return document, binary


@pytest.mark.parametrize("mirror", [1.0, -2.0])
def test_a_gltf_mesh_that_moves_differently_at_its_places_is_repeated(mirror: float, tmp_path: Path) -> None:
    document, binary = placed_twice(mirror)
    scan = read_bytes(documents.glb(document, binary), "glb", ReadLimits())
    half = len(scan.vertices) // 2
    alike = scan.vertices + np.array([0, 0.25, 0])
    one, _ = documents.chunks(write(scan, Moved(alike), tmp_path)[0])
    assert len(one["meshes"]) == 1
    assert len(one["accessors"]) == len(document["accessors"])
    different = np.where(np.arange(len(alike))[:, np.newaxis] < half, alike, scan.vertices)
    data, _ = write(scan, Moved(different), tmp_path)
    two, _ = documents.chunks(data)
    assert [node["mesh"] for node in two["nodes"]] == [0, 1]
    assert two["accessors"][0]["max"][1] == pytest.approx(alike[:half, 1].max())
    again = read_bytes(data, "glb", ReadLimits())
    assert np.abs(again.vertices - different).max() < 1e-6
    assert (again.vertices[half:] == scan.vertices[half:]).all()
    assert np.abs(normals(again)[half:] - normals(scan)[half:]).max() < 1e-6


def test_primitives_that_share_their_gltf_array_share_it_still(tmp_path: Path) -> None:
    document, binary = documents.scene(BALL.vertices, BALL.triangles, {"mesh": 0})
    primitive = document["meshes"][0]["primitives"][0]
    n_first = 3 * (len(BALL.triangles) // 2)
    indices = document["accessors"][-1]
    document["accessors"] += [
        {**indices, "count": n_first},
        {**indices, "count": indices["count"] - n_first, "byteOffset": 2 * n_first},
    ]
    n = len(document["accessors"])
    document["meshes"][0]["primitives"] = [
        {**primitive, "indices": n - 2},
        {**primitive, "indices": n - 1, "material": 1},
    ]
    scan = read_bytes(documents.glb(document, binary), "glb", ReadLimits())
    used = np.zeros(len(scan.vertices), dtype=bool)
    used[scan.triangles] = True
    vertices = np.where(used[:, np.newaxis], scan.vertices * 2, scan.vertices)
    data, _ = write(scan, Moved(vertices), tmp_path)
    after, buffer = documents.chunks(data)
    assert len(after["accessors"]) == n
    assert len(buffer) == len(binary) + -len(binary) % 4
    again = read_bytes(data, "glb", ReadLimits())
    assert (again.vertices[again.triangles] == vertices[scan.triangles]).all()


def test_a_gltf_array_of_integers_becomes_one_of_fractions(tmp_path: Path) -> None:
    document, binary = documents.scene(np.zeros((3, 3)), np.array([[0, 1, 2]]), {"mesh": 0})
    stored = np.array([[0, 0, 0], [9, 0, 0], [0, 9, 0]], "<i2").tobytes()
    document["accessors"][0]["componentType"] = 5122
    document["bufferViews"][0]["byteLength"] = len(stored)
    scan = read_bytes(documents.glb(document, stored + binary[len(stored) :]), "glb", ReadLimits())
    data, warnings = write(scan, Moved(scan.vertices + 0.25), tmp_path)
    assert warnings == []
    assert (read_bytes(data, "glb", ReadLimits()).vertices == scan.vertices + 0.25).all()


def test_a_gltf_file_with_a_buffer_beside_it_is_written_whole(tmp_path: Path) -> None:
    document, binary = documents.scene(BALL.vertices, BALL.triangles, {"mesh": 0})
    document["buffers"][0]["uri"] = "mesh.bin"
    (tmp_path / "mesh.bin").write_bytes(binary)
    (tmp_path / "in.gltf").write_text(json.dumps(document))
    scan = read_scan(tmp_path / "in.gltf")
    (tmp_path / "elsewhere").mkdir()
    for shift in (0.0, 0.25):
        data, _ = write(scan, Moved(scan.vertices + shift), tmp_path / "elsewhere")
        assert np.abs(read_bytes(data, "gltf", ReadLimits()).vertices - scan.vertices - shift).max() < 1e-6


def mesh(scan: Scan) -> str:
    return f'<object id="1" type="model">{packages.mesh_text(scan)}</object>'


def test_a_threemf_keeps_comments_and_what_it_does_not_know(tmp_path: Path) -> None:
    body = (
        mesh(BALL)
        .replace("<vertex x=", "<vertex p:UUID='x=\"1\"' x  =  ", 1)
        .replace("<vertices>", '<vertices><!-- <vertex x="9" y="9" z="9"/> -->')
    )
    data = packages.package(packages.model(body, '<item objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/>'))
    scan = read_bytes(data, "3mf", ReadLimits())
    moved = Moved(scan.vertices.copy())
    moved.vertices[0] += 0.25
    new, warnings = write(scan, moved, tmp_path)
    assert warnings == []
    assert np.abs(read_bytes(new, "3mf", ReadLimits()).vertices - moved.vertices).max() < 1e-12
    before, after = model_text(data), model_text(new)
    start = before.index("<vertex p:UUID")
    end = before.index('"/>', start)
    assert after.startswith(before[:start])
    assert after.endswith(before[end:])


def model_text(data: bytes) -> str:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return archive.read("3D/3dmodel.model").decode()


def test_a_threemf_object_that_moves_differently_at_its_places_is_written_anew(tmp_path: Path) -> None:
    items = '<item objectid="1"/><item objectid="1" transform="1 0 0 0 1 0 0 0 1 8 0 0"/>'
    scan = read_bytes(packages.package(packages.model(mesh(BALL), items)), "3mf", ReadLimits())
    alike, warnings = write(scan, Moved(scan.vertices + np.array([0, 0, 0.25])), tmp_path)
    assert warnings == []
    assert model_text(alike).count("<object") == 1
    moved = Moved(scan.vertices * 1.5)
    data, (warning,) = write(scan, moved, tmp_path)
    assert "builds object '1' several times, and its places moved differently" in warning
    assert (read_bytes(data, "3mf", ReadLimits()).vertices == moved.vertices).all()


def test_a_part_that_is_flattened_can_stay_but_not_move(tmp_path: Path) -> None:
    document, binary = documents.scene(BALL.vertices, BALL.triangles, {"mesh": 0, "scale": [1, 1, 0]})
    scan = read_bytes(documents.glb(document, binary), "glb", ReadLimits())
    data, (warning,) = write(scan, Moved(scan.vertices + np.array([0, 0, 1])), tmp_path)
    assert "a transform flattens a part" in warning
    assert (read_bytes(data, "glb", ReadLimits()).vertices[:, 2] == 1).all()


def test_a_property_must_be_one_number_for_each_vertex(tmp_path: Path) -> None:
    short = {"shift": np.zeros(3, np.float32)}
    for properties in (short, {"x": np.zeros(len(BALL.vertices))}, {"two words": np.zeros(len(BALL.vertices))}):
        with pytest.raises(ValueError, match="is no property"):
            write(BALL, Moved(BALL.vertices, properties), tmp_path, "ply")
