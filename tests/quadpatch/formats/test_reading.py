"""Whatever a file holds, reading it gives a scan or an error of the method's own."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from quadpatch.errors import EmptyMeshError, FormatError, MeshError, QuadpatchError, ReadError, TooLargeError
from quadpatch.formats.reading import ReadLimits, read_scan
from quadpatch.formats.scan import Scan
from quadpatch.formats.writing import write_scan
from tests.quadpatch.formats.fills import EMPTY, INPUTS, as_scan, cap_holes
from tests.quadpatch.shapes import punched, sphere

FORMATS = ("ply", "stl", "obj", "off", "glb", "gltf", "3mf")
EXPECTED_CODES = {
    "empty.stl": "empty_mesh",
    "obj_wireframe.obj": "empty_mesh",
    "points_bin.ply": "empty_mesh",
    "ply_empty_bin.ply": "empty_mesh",
    "issue623.ply": "unreadable_mesh",
    "bun000.ply": "unsupported_format",
    "invalid.off": "unreadable_mesh",
    "OutOfMemory.off": "mesh_too_large",
    "BoxWithInfinites.glb": "not_finite",
    "IndexOutOfRange.gltf": "index_out_of_range",
    "RecursiveNodes.gltf": "unreadable_mesh",
    "2CylinderEngine.gltf": "unsupported_format",
    "pyramid.3mf": "empty_mesh",
    "fuze.zip": "unsupported_format",
    "off.zip": "unsupported_format",
    "blue_cube.dae": "unsupported_format",
}


NO_INPUTS = pytest.param(
    Path("none"), marks=pytest.mark.skip(reason="the folder of real meshes is not beside the repository")
)


def real_inputs() -> list[Path]:
    manifest = INPUTS / "manifest.json"
    if not manifest.exists():
        return []
    entries = json.loads(manifest.read_text())
    return [INPUTS / entry["file"] for entry in entries if not entry["sidecar"]]


@pytest.mark.parametrize("path", real_inputs() or [NO_INPUTS], ids=lambda path: path.name)
def test_a_real_file_gives_a_scan_that_comes_back_with_its_bits_or_the_error_it_deserves(
    path: Path, tmp_path: Path
) -> None:
    if path.name in EXPECTED_CODES:
        with pytest.raises(MeshError) as caught:
            read_scan(path)
        assert caught.value.code == EXPECTED_CODES[path.name]
        return
    scan = read_scan(path)
    fill = cap_holes(scan)
    out = tmp_path / f"out.{scan.format}"
    write_scan(out, scan, fill)
    again = read_scan(out)
    n_triangles = len(scan.triangles)
    assert len(again.triangles) == n_triangles + len(fill.triangles)
    old = again.vertices[again.triangles[:n_triangles]]
    assert old.tobytes() == scan.vertices[scan.triangles].tobytes()
    new = np.concatenate([scan.vertices, fill.vertices])[fill.triangles]
    assert np.abs(again.vertices[again.triangles[n_triangles:]] - new).max(initial=0) <= 1e-6 * np.abs(new).max(
        initial=1
    )


def closed_ball_with_hole() -> Scan:
    return as_scan(punched(sphere(2, radius=3.0), (0.0, 0.0, 3.0), radius=1.2))


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """One small mesh in every format."""
    folder = tmp_path_factory.mktemp("files")
    scan = closed_ball_with_hole()
    for suffix in FORMATS:
        write_scan(folder / f"mesh.{suffix}", scan, EMPTY)
    ascii_ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    ascii_ply += "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    ascii_stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    texts = {"ascii.ply": ascii_ply.encode(), "ascii.stl": (ascii_stl + "endsolid a\n").encode()}
    return {suffix: (folder / f"mesh.{suffix}").read_bytes() for suffix in FORMATS} | texts


@given(data=st.data())
@settings(max_examples=300, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
def test_damaged_files_raise_nothing_but_errors_of_the_method(
    data: st.DataObject, files: dict[str, bytes], tmp_path: Path
) -> None:
    name = data.draw(st.sampled_from(sorted(files)))
    damaged = bytearray(files[name])
    kind = data.draw(st.sampled_from(["truncate", "flip", "replace", "repeat", "word"]))
    if kind == "truncate":
        del damaged[data.draw(st.integers(0, len(damaged))) :]
    elif kind == "repeat":
        at, size = data.draw(st.integers(0, len(damaged))), data.draw(st.integers(1, 60))
        damaged[at:at] = damaged[at : at + size]
    elif kind == "word":
        at = data.draw(st.integers(0, min(len(damaged), 400)))
        damaged[at : at + 1] = data.draw(
            st.sampled_from([b"-", b"9999999999999", b"nan", b"1e400", b"\0", b"\n", b"#"])
        )
    else:
        for _ in range(data.draw(st.integers(1, 4))):
            at = data.draw(st.integers(0, len(damaged) - 1))
            damaged[at] = damaged[at] ^ (1 << data.draw(st.integers(0, 7))) if kind == "flip" else 0xFF
    path = tmp_path / ("x." + name.rsplit(".", 1)[-1])
    path.write_bytes(damaged)
    try:
        scan = read_scan(path)
    except QuadpatchError:
        return
    # What was read can be written, and read again.
    out = tmp_path / f"out.{scan.format}"
    write_scan(out, scan, EMPTY)
    assert len(read_scan(out).triangles) == len(scan.triangles)


@pytest.mark.parametrize("suffix", FORMATS)
def test_the_content_says_the_format_and_the_suffix_does_not(
    suffix: str, files: dict[str, bytes], tmp_path: Path
) -> None:
    for wrong in ("", ".stl", ".ply", ".obj", ".jpeg"):
        path = tmp_path / f"mesh{wrong}"
        path.write_bytes(files[suffix])
        assert read_scan(path).format == suffix


def test_a_file_that_is_not_there_is_a_read_error(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"gone\.ply can't be read"):
        read_scan(tmp_path / "gone.ply")


@pytest.mark.parametrize("content", [b"", b"\0" * 500, b" \n\t"])
def test_an_empty_file_is_a_read_error(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "mesh.ply"
    path.write_bytes(content)
    with pytest.raises(ReadError):
        read_scan(path)


@pytest.mark.parametrize("content", [b"hello, this is a letter", b"\x89PNG\r\n\x1a\n" + bytes(range(256))])
def test_other_files_are_unsupported(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "file.bin"
    path.write_bytes(content)
    with pytest.raises(FormatError):
        read_scan(path)


@pytest.mark.parametrize("suffix", FORMATS)
@pytest.mark.parametrize(
    "limits", [ReadLimits(max_vertices=20), ReadLimits(max_triangles=20), ReadLimits(max_bytes=99)]
)
def test_limits_hold_in_every_format(suffix: str, limits: ReadLimits, files: dict[str, bytes], tmp_path: Path) -> None:
    path = tmp_path / f"mesh.{suffix}"
    path.write_bytes(files[suffix])
    with pytest.raises(TooLargeError):
        read_scan(path, limits)


def test_points_are_no_mesh(tmp_path: Path) -> None:
    path = tmp_path / "points.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n")
    with pytest.raises(EmptyMeshError):
        read_scan(path)


@pytest.mark.parametrize("suffix", ["ply", "stl", "glb"])
def test_a_scan_that_is_cut_short_during_its_repair_is_written_as_it_was_read(suffix: str, tmp_path: Path) -> None:
    """A file that is mapped into memory would end the process by a signal, or be another one by then."""
    path = tmp_path / f"scan.{suffix}"
    write_scan(path, as_scan(punched(sphere(3), (0, 0, 1), radius=0.4)), EMPTY)
    scan = read_scan(path)
    fill = cap_holes(scan)
    write_scan(tmp_path / f"before.{suffix}", scan, fill)
    os.truncate(path, 100)
    write_scan(tmp_path / f"after.{suffix}", scan, fill)
    assert (tmp_path / f"after.{suffix}").read_bytes() == (tmp_path / f"before.{suffix}").read_bytes()
    with pytest.raises(MeshError):
        read_scan(path)
