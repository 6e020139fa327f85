import json
from pathlib import Path

import numpy as np
import pytest

from quadpatch.errors import OptionError
from quadpatch.formats.moving import write_moved
from quadpatch.formats.reading import read_scan
from quadpatch.formats.scan import Moved, Scan
from quadpatch.formats.vertex_properties import vertex_property
from quadpatch.restoration.restore import RestoreOptions
from quadpatch.tasks.restore import restore_file
from quadpatch.types import TriangleMesh
from tests.quadpatch.restoration.boxes import scattered
from tests.quadpatch.shapes import joined, moved, sphere, write_ply

BALL = sphere(4)
MISSING = scattered(BALL, 0.3)


def holed(path: Path, mesh: TriangleMesh = BALL) -> Path:
    """Write a mesh whose missing vertices are NaN."""
    missing = np.zeros(len(mesh.vertices), bool)
    missing[: len(MISSING)] = MISSING
    return write_ply(path, TriangleMesh(np.where(missing[:, None], np.nan, mesh.vertices), mesh.triangles))


def test_vertices_that_are_nan_are_restored_and_marked(tmp_path: Path) -> None:
    source, output = holed(tmp_path / "in.ply"), tmp_path / "out.ply"
    result = restore_file(source, output)
    after = read_scan(output)
    assert after.vertices[~MISSING].tobytes() == BALL.vertices[~MISSING].tobytes()
    assert np.abs(np.linalg.norm(after.vertices[MISSING], axis=1) - 1).max() < 0.01
    np.testing.assert_array_equal(vertex_property(after, "restored"), MISSING)
    assert (vertex_property(after, "expected_error")[MISSING] > 0).all()
    assert result.report["vertices"] == {"missing": MISSING.sum(), "restored": MISSING.sum(), "left": 0}
    assert result.report["task"] == "restore"
    json.dumps(result.report, allow_nan=False)
    np.testing.assert_array_equal(result.changed, MISSING[result.after.triangles].any(axis=1))
    assert np.isfinite(result.before.vertices[result.before.triangles]).all()


def test_a_property_of_the_file_says_what_is_missing(tmp_path: Path) -> None:
    """What stands in place of a missing vertex is not looked at."""
    source, output = tmp_path / "in.ply", tmp_path / "out.ply"
    plain = read_scan(write_ply(tmp_path / "plain.ply", BALL))
    garbage = np.where(MISSING[:, None], 0.25, BALL.vertices)
    write_moved(source, plain, Moved(garbage, {"gone": MISSING.astype(np.uint8)}))
    restore_file(source, output, "property:gone", "smooth")
    restore_file(holed(tmp_path / "nan.ply"), tmp_path / "nan-out.ply", "nan", "smooth")
    one, other = read_scan(output), read_scan(tmp_path / "nan-out.ply")
    assert one.vertices.tobytes() == other.vertices.tobytes()


def test_a_list_says_what_is_missing(tmp_path: Path) -> None:
    np.save(tmp_path / "list.npy", np.flatnonzero(MISSING))
    source, output = write_ply(tmp_path / "in.ply", BALL), tmp_path / "out.ply"
    report = restore_file(source, output, tmp_path / "list.npy", "smooth").report
    assert report["vertices"]["restored"] == MISSING.sum()
    assert report["model"] == {"name": "smooth"}
    assert report["patches"] is None


def test_the_same_input_gives_the_same_bytes(tmp_path: Path) -> None:
    source = holed(tmp_path / "in.ply")
    for name in ("one.ply", "two.ply"):
        restore_file(source, tmp_path / name, options=RestoreOptions(seed=5))
    assert (tmp_path / "one.ply").read_bytes() == (tmp_path / "two.ply").read_bytes()


def test_a_missing_vertex_without_a_measured_neighbour_is_left_and_named(tmp_path: Path) -> None:
    n = len(BALL.vertices)
    mesh = joined(BALL, moved(sphere(0), (5.0, 0, 0)))
    np.save(tmp_path / "list.npy", np.concatenate([np.flatnonzero(MISSING), np.arange(n, n + 12)]))
    source, output = write_ply(tmp_path / "in.ply", mesh), tmp_path / "out.ply"
    report = restore_file(source, output, tmp_path / "list.npy", "smooth").report
    assert report["vertices"]["left"] == 12
    assert "12 missing vertices" in report["warnings"][-1]
    assert read_scan(output).vertices[n:].tobytes() == mesh.vertices[n:].tobytes()


def test_another_format_gets_the_positions(tmp_path: Path) -> None:
    report = restore_file(holed(tmp_path / "in.ply"), tmp_path / "out.obj", "nan", "smooth").report
    after: Scan = read_scan(tmp_path / "out.obj")
    np.testing.assert_allclose(after.vertices[~MISSING], BALL.vertices[~MISSING])
    assert any("restored" in warning for warning in report["warnings"])


def test_a_network_that_needs_fitting_is_refused(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match="fitting"):
        restore_file(holed(tmp_path / "in.ply"), tmp_path / "out.ply", "nan", "self-network")


def test_a_coarse_mesh_is_tried(tmp_path: Path) -> None:
    coarse = write_ply(tmp_path / "coarse.ply", sphere(3))
    report = restore_file(holed(tmp_path / "in.ply"), tmp_path / "out.ply", "nan", "smooth", coarse=coarse).report
    assert "base_surface" in report["hidden_vertices"]["rms_error"]
