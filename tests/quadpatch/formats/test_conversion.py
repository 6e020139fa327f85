"""One format in, another out.

Also tests `quadpatch.formats.gltf.encoder`, `quadpatch.formats.ply.vertex_attributes`,
`quadpatch.formats.threemf.encoder` and `quadpatch.formats.merged_scene`.
"""

import io
from pathlib import Path

import numpy as np
import pytest
import trimesh

from quadpatch.errors import FormatError
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.ply.reader import read_ply
from quadpatch.formats.reading import read_scan
from quadpatch.formats.scan import Scan
from quadpatch.formats.writing import write_scan
from quadpatch_rules.option_words import CarriedAttribute
from tests.quadpatch.formats.fills import EMPTY, as_scan, cap_holes, n_open_edges
from tests.quadpatch.shapes import punched, sphere

FORMATS = ("ply", "stl", "obj", "off", "glb", "gltf", "3mf")


def textured_ball() -> Scan:
    """A ball with a hole, out of a PLY with colours, normals and texture coordinates."""
    mesh = as_scan(punched(sphere(2), (0, 0, 1), radius=0.5))
    names = ["x", "y", "z", "nx", "ny", "nz", "s", "t"]
    table = np.concatenate([mesh.vertices, mesh.vertices, mesh.vertices[:, :2] / 4 + 0.5], axis=1)
    rows = np.zeros(len(table), [(name, "<f8") for name in names] + [(name, "u1") for name in ("red", "green", "blue")])
    for name, column in zip(names, table.T, strict=True):
        rows[name] = column
    rows["red"] = 200 * (mesh.vertices[:, 0] > 0)
    faces = np.zeros(len(mesh.triangles), [("n", "u1"), ("v", "<i4", (3,))])
    faces["n"], faces["v"] = 3, mesh.triangles
    head = "ply\nformat binary_little_endian 1.0\n" + f"element vertex {len(rows)}\n"
    head += "".join(f"property double {name}\n" for name in names)
    head += "property uchar red\nproperty uchar green\nproperty uchar blue\n"
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    return read_ply(head.encode() + rows.tobytes() + faces.tobytes(), ReadLimits())


@pytest.mark.parametrize("suffix", FORMATS)
def test_the_surface_survives_any_conversion_closed_and_in_order(suffix: str, tmp_path: Path) -> None:
    scan = textured_ball()
    fill = cap_holes(scan)
    path = tmp_path / f"out.{suffix}"
    write_scan(path, scan, fill)
    again = read_scan(path)
    assert again.format == suffix
    assert n_open_edges(again) == 0
    vertices = np.concatenate([scan.vertices, fill.vertices])
    both = vertices[np.concatenate([scan.triangles, fill.triangles])]
    if suffix in ("stl", "glb", "gltf"):
        both = both.astype(np.float32).astype(np.float64)
    assert again.vertices[again.triangles].tobytes() == both.tobytes()


@pytest.mark.parametrize("suffix", ["obj", "glb", "gltf"])
def test_texture_and_normals_survive_where_there_is_room(suffix: str, tmp_path: Path) -> None:
    scan = textured_ball()
    write_scan(tmp_path / f"out.{suffix}", scan, cap_holes(scan))
    again = read_scan(tmp_path / f"out.{suffix}")
    assert again.source is not None
    assert scan.source is not None
    old, new = scan.source.vertex_attributes(scan), again.source.vertex_attributes(again)
    assert old.texture is not None
    assert new.texture is not None
    assert new.normals is not None
    assert np.abs(new.texture[: len(scan.triangles)] - old.texture).max() < 1e-6
    measured = again.vertices[again.triangles[: len(scan.triangles)]]
    assert np.abs(new.normals[again.triangles[: len(scan.triangles)]] - measured).max() < 1e-6


@pytest.mark.parametrize("suffix", ["obj", "off", "glb", "3mf"])
def test_colours_survive_where_there_is_room(suffix: str, tmp_path: Path) -> None:
    scan = textured_ball()
    write_scan(tmp_path / f"out.{suffix}", scan, cap_holes(scan))
    again = read_scan(tmp_path / f"out.{suffix}")
    assert again.source is not None
    colours = again.source.vertex_attributes(again).colours
    assert colours is not None
    corners = again.triangles[: len(scan.triangles)]
    expected = 200.0 * (again.vertices[corners][:, :, 0] > 0)
    assert np.abs(colours[corners][:, :, 0] - expected).max() < 1e-3
    assert (colours[:, 0] <= 200.001).all()


def test_a_conversion_carries_what_was_asked_for(tmp_path: Path) -> None:
    scan = textured_ball()
    choices: list[tuple[CarriedAttribute, ...]] = [(), ("normals",), ("colours", "texture_coordinates")]
    for names in choices:
        write_scan(tmp_path / "out.glb", scan, cap_holes(scan), names)
        again = read_scan(tmp_path / "out.glb")
        assert again.source is not None
        has = again.source.vertex_attributes(again)
        found = {"colours": has.colours, "normals": has.normals, "texture_coordinates": has.texture}
        assert {name for name, value in found.items() if value is not None} == set(names)


@pytest.mark.parametrize("suffix", ["ply", "obj", "off", "3mf"])
def test_float64_coordinates_are_exact_where_the_format_allows(suffix: str, tmp_path: Path) -> None:
    ball = sphere(1)
    scan = Scan(1200 + ball.vertices / 3, ball.triangles, "memory")
    write_scan(tmp_path / f"out.{suffix}", scan, EMPTY)
    again = read_scan(tmp_path / f"out.{suffix}")
    assert again.vertices.tobytes() == scan.vertices.tobytes()
    assert again.triangles.tolist() == scan.triangles.tolist()


def test_units_go_along(tmp_path: Path) -> None:
    ball = sphere(1)
    scan = Scan(ball.vertices, ball.triangles, "memory", unit="inch")
    write_scan(tmp_path / "out.3mf", scan, EMPTY)
    assert read_scan(tmp_path / "out.3mf").unit == "inch"
    write_scan(tmp_path / "out.glb", scan, EMPTY)
    metres = read_scan(tmp_path / "out.glb")
    assert np.allclose(metres.vertices, 0.0254 * scan.vertices.astype(np.float32))
    write_scan(tmp_path / "out.ply", scan, EMPTY)
    assert b"comment unit inch\n" in (tmp_path / "out.ply").read_bytes()


@pytest.mark.parametrize("suffix", ["glb", "3mf", "obj", "stl", "off", "ply"])
def test_another_reader_sees_the_same_surface(suffix: str, tmp_path: Path) -> None:
    scan = textured_ball()
    fill = cap_holes(scan)
    write_scan(tmp_path / f"out.{suffix}", scan, fill)
    data = io.BytesIO((tmp_path / f"out.{suffix}").read_bytes())
    loaded = trimesh.load(data, file_type=suffix, process=False)
    geometries = loaded.geometry.values() if isinstance(loaded, trimesh.Scene) else [loaded]
    assert sum(len(geometry.faces) for geometry in geometries) == len(scan.triangles) + len(fill.triangles)
    area = sum(geometry.area for geometry in geometries)
    corners = np.concatenate([scan.vertices, fill.vertices])[np.concatenate([scan.triangles, fill.triangles])]
    expected = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
    assert np.isclose(area, expected, rtol=1e-6)


def test_unknown_suffixes_are_not_written(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match=r"\.xyz"):
        write_scan(tmp_path / "out.xyz", textured_ball(), EMPTY)
