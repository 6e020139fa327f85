"""Tests `quadpatch.tasks.measures` as well."""

import json
from pathlib import Path

import numpy as np
import pytest

from quadpatch.compression.collapse_estimate import estimated_collapse_bytes
from quadpatch.compression.encode import EncodeOptions
from quadpatch.errors import FormatError, ModelError, OptionError
from quadpatch.formats.reading import read_scan
from quadpatch.inpainters.model_file import save_dictionary
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.tasks.decode import decode_file
from quadpatch.tasks.encode import encode_file
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import joined, open_grid, relief, sphere, write_ply

ERROR = 0.02


def model_file(folder: Path, seed: int) -> Path:
    atoms = np.random.default_rng(seed).normal(size=(64, 12))
    path = folder / f"model{seed}.safetensors"
    save_dictionary(path, Dictionary(np.asarray(atoms / np.linalg.norm(atoms, axis=0)), 8, 4), {"name": f"m{seed}"})
    return path


@pytest.mark.parametrize("keep", [False, True])
def test_a_file_comes_back_within_the_promised_error(tmp_path: Path, keep: bool) -> None:
    mesh = relief(20, waves=3)
    source = write_ply(tmp_path / "in.ply", mesh)
    report = encode_file(source, tmp_path / "a.qpz", options=EncodeOptions(ERROR, keep)).report
    decode_file(tmp_path / "a.qpz", tmp_path / "out.ply")
    scan = read_scan(tmp_path / "out.ply")
    found = TriangleMesh(scan.vertices, scan.triangles)
    assert distance_to_mesh(mesh.vertices, found).max() <= ERROR
    assert distance_to_mesh(found.vertices, mesh).max() <= ERROR
    assert report["bytes"] == (tmp_path / "a.qpz").stat().st_size
    assert max(report["max_error"]["true_to_decoded"], report["max_error"]["decoded_to_true"]) <= ERROR
    if keep:
        assert (scan.triangles == mesh.triangles).all()


def test_the_report_is_json_and_counts_entities_as_it_says(tmp_path: Path) -> None:
    source = write_ply(tmp_path / "in.ply", sphere(3))
    report = json.loads(json.dumps(encode_file(source, tmp_path / "a.qpz", options=EncodeOptions(ERROR)).report))
    assert report["entity_factor"] == pytest.approx(report["entities"]["mesh"] / report["entities"]["file"])
    assert report["entities"]["mesh"] == 3 * len(sphere(3).vertices)
    assert {"schema", "task", "source", "length_unit", "model", "options", "stages", "warnings", "psnr"} <= set(report)


def test_an_error_must_be_given_and_the_output_be_a_qpz_file(tmp_path: Path) -> None:
    source = write_ply(tmp_path / "in.ply", sphere(2))
    with pytest.raises(OptionError, match="max_error must be given"):
        encode_file(source, tmp_path / "a.qpz")
    with pytest.raises(FormatError, match="qpz"):
        encode_file(source, tmp_path / "a.ply", options=EncodeOptions(ERROR))


def test_a_file_over_a_model_needs_that_model(tmp_path: Path) -> None:
    source = write_ply(tmp_path / "in.ply", sphere(2))
    own, other = model_file(tmp_path, 1), model_file(tmp_path, 2)
    encode_file(source, tmp_path / "a.qpz", own, EncodeOptions(ERROR))
    assert decode_file(tmp_path / "a.qpz", tmp_path / "out.ply", own).report["model"]["name"] == "m1"
    with pytest.raises(ModelError, match="another dictionary"):
        decode_file(tmp_path / "a.qpz", tmp_path / "out.ply", other)
    with pytest.raises(ModelError):
        decode_file(tmp_path / "a.qpz", tmp_path / "out.ply")


def test_a_shipped_model_is_found_by_the_name_in_the_file(tmp_path: Path) -> None:
    source = write_ply(tmp_path / "in.ply", relief(20, waves=3))
    encode_file(source, tmp_path / "a.qpz", "general-dictionary", EncodeOptions(ERROR))
    assert decode_file(tmp_path / "a.qpz", tmp_path / "out.ply").report["model"]["name"] == "general-dictionary@1"


def test_a_network_is_refused(tmp_path: Path) -> None:
    source = write_ply(tmp_path / "in.ply", sphere(2))
    with pytest.raises(OptionError, match="is a network"):
        encode_file(source, tmp_path / "a.qpz", "general-residual", EncodeOptions(ERROR))


def test_colours_are_left_out_with_a_warning(tmp_path: Path) -> None:
    mesh = sphere(2)
    rows = "".join(f"{x} {y} {z} 200 100 50\n" for x, y, z in mesh.vertices.tolist())
    faces = "".join(f"3 {a} {b} {c}\n" for a, b, c in mesh.triangles.tolist())
    colours = "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))
    places = "".join(f"property float {axis}\n" for axis in "xyz")
    head = f"ply\nformat ascii 1.0\nelement vertex {len(mesh.vertices)}\n{places}{colours}"
    head += f"element face {len(mesh.triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    (tmp_path / "in.ply").write_text(head + rows + faces)
    warnings = encode_file(tmp_path / "in.ply", tmp_path / "a.qpz", options=EncodeOptions(ERROR)).report["warnings"]
    assert any("colours" in warning for warning in warnings)


def test_draco_is_suggested_where_flat_faces_collapse_to_a_few_triangles(tmp_path: Path) -> None:
    source = write_ply(tmp_path / "in.ply", box(24))
    report = encode_file(source, tmp_path / "a.qpz", options=EncodeOptions(0.002)).report
    assert report["draco_estimate"] < report["bytes"]
    assert any("Draco" in warning for warning in report["warnings"])


def test_more_error_means_fewer_estimated_bytes() -> None:
    fine, coarse = (estimated_collapse_bytes(sphere(4), rms) for rms in (0.004, 0.02))
    assert fine is not None
    assert coarse is not None
    assert coarse < fine
    assert estimated_collapse_bytes(sphere(2), 1e-9) is None


def box(n: int) -> TriangleMesh:
    """A closed cube whose faces are grids."""
    flat = open_grid(n, width=1.0)
    centred = flat.vertices - flat.vertices.mean(axis=0)
    faces = []
    for axis in range(3):
        for side in (-0.5, 0.5):
            places = np.roll(centred + np.array([0.0, 0.0, side]), axis + 1, axis=1)
            faces.append(TriangleMesh(places, flat.triangles if side > 0 else flat.triangles[:, ::-1]))
    mesh = joined(*faces)
    places, index = np.unique(np.round(mesh.vertices, 9), axis=0, return_inverse=True)
    return TriangleMesh(places, index[mesh.triangles])
