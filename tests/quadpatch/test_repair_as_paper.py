"""`repair_file` by the paper's recipe: the method itself is tested in `test_paper.py`."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.errors import EmptyMeshError, ModelError, OptionError
from quadpatch.formats.reading import read_scan
from quadpatch.inpainters.model_file import save_dictionary
from quadpatch.options import DictionaryOptions, HoleOptions, PatchOptions, RepairOptions
from quadpatch.patches.normalisation import HEIGHTS, NORMALISATION
from quadpatch.repair import repair_file
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.types import TriangleMesh
from tests.quadpatch.inpainters.test_onnx_network import PAPER as NETWORK
from tests.quadpatch.inpainters.test_onnx_network import RESIDUAL, write_network
from tests.quadpatch.shapes import has_a_face, punched, relief, write_ply

PLACES = [(x, y, 0.0) for x in (-0.5, 0.5) for y in (-0.45, 0.5)]
PAPER = RepairOptions(patches=PatchOptions(0.4, 8), recipe="paper")


@pytest.fixture(scope="module")
def scan_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    mesh = punched(relief(60, 2.0, 0.03, 8), *PLACES, radius=0.13)
    return write_ply(tmp_path_factory.mktemp("scan") / "relief.ply", mesh)


def dictionary_file(folder: Path, normalisation: str) -> Path:
    path = folder / f"{normalisation}.safetensors"
    atoms = np.random.default_rng(0).normal(size=(64, 20))
    save_dictionary(path, Dictionary(atoms / np.linalg.norm(atoms, axis=0), 8, 3), {"name": "mine"}, normalisation)
    return path


@pytest.mark.parametrize("of_its_own", [False, True])
def test_a_file_is_repaired_by_the_paper_and_keeps_every_bit(scan_file: Path, tmp_path: Path, of_its_own: bool) -> None:
    model = dictionary_file(tmp_path, HEIGHTS) if of_its_own else "self"
    report = repair_file(scan_file, tmp_path / "out.ply", model, PAPER)
    before, after = read_scan(scan_file), read_scan(tmp_path / "out.ply")
    assert after.vertices[: len(before.vertices)].tobytes() == before.vertices.tobytes()
    assert after.triangles[: len(before.triangles)].tobytes() == before.triangles.tobytes()
    assert json.loads(json.dumps(report, allow_nan=False)) == report
    assert report["options"]["recipe"] == "paper"
    assert report["model"]["name"] == ("mine" if of_its_own else "self")
    assert report["counts"]["filled"] == 4
    assert report["patches"]["resolution"] == 8
    assert report["patches"]["believed_share"] == 1.0
    for hole in report["holes"]:
        assert (hole["confidence"], hole["expected_error"]) == (None, None)
    repair_file(scan_file, tmp_path / "again.ply", model, PAPER)
    assert (tmp_path / "again.ply").read_bytes() == (tmp_path / "out.ply").read_bytes()


@pytest.mark.parametrize(("hole", "length"), [(None, 0.3 * 2.05), (0.5, 0.5)])
def test_patches_are_as_wide_as_those_that_were_learned_from(
    scan_file: Path, tmp_path: Path, hole: float | None, length: float
) -> None:
    """Unless a length is asked for, or the holes are too wide for them."""
    path = tmp_path / "heights.safetensors"
    atoms = np.random.default_rng(0).normal(size=(64, 20))
    dictionary = Dictionary(atoms / np.linalg.norm(atoms, axis=0), 8, 3)
    save_dictionary(path, dictionary, {"name": "mine", "length_share": 0.3}, HEIGHTS)
    report = repair_file(
        scan_file, tmp_path / "out.ply", path, RepairOptions(patches=PatchOptions(hole), recipe="paper")
    )
    assert report["patches"]["length"] == pytest.approx(length, rel=0.01)


@pytest.mark.parametrize("share", [True, "wide", 0, 1.5])
def test_a_share_that_is_none_is_refused(scan_file: Path, tmp_path: Path, share: object) -> None:
    path = tmp_path / "heights.safetensors"
    save_dictionary(path, Dictionary(np.eye(64)[:, :20], 8, 3), {"name": "mine", "length_share": share}, HEIGHTS)
    with pytest.raises(ModelError, match="length_share must lie between 0 and 1"):
        repair_file(scan_file, tmp_path / "out.ply", path, RepairOptions(recipe="paper"))


def test_a_network_of_the_paper_places_new_vertices_by_either_recipe(scan_file: Path, tmp_path: Path) -> None:
    """This one copies its input, in which unknown bins are 1: the top of its range, far above the surface."""
    network = write_network(tmp_path / "copy.onnx", NETWORK, 1)
    report = repair_file(scan_file, tmp_path / "out.ply", network, PAPER)
    before, after = read_scan(scan_file), read_scan(tmp_path / "out.ply")
    assert after.vertices[: len(before.vertices)].tobytes() == before.vertices.tobytes()
    assert (report["model"]["kind"], report["options"]["recipe"]) == ("autoencoder", "paper")
    assert report["patches"]["resolution"] == 16
    # In patches of length 0.4 the range is 0.4 wide, and 1 lies above it.
    assert np.median(after.vertices[len(before.vertices) :, 2]) == pytest.approx(0.4 * (1 / 0.83 - 0.5), rel=0.2)
    assert repair_file(scan_file, tmp_path / "ours.ply", network)["options"]["recipe"] == "default"


def test_a_dictionary_learned_for_the_other_recipe_is_refused(scan_file: Path, tmp_path: Path) -> None:
    ours, papers = dictionary_file(tmp_path, NORMALISATION), dictionary_file(tmp_path, HEIGHTS)
    with pytest.raises(OptionError, match="learned for the recipe default, not for paper: ask for the recipe default"):
        repair_file(scan_file, tmp_path / "out.ply", ours, PAPER)
    with pytest.raises(OptionError, match="learned for the recipe paper, not for default: ask for the recipe paper"):
        repair_file(scan_file, tmp_path / "out.ply", papers)


def test_what_the_recipe_has_no_use_for_is_refused(scan_file: Path, tmp_path: Path) -> None:
    output = tmp_path / "out.ply"
    with pytest.raises(OptionError, match="with smooth there is none"):
        repair_file(scan_file, output, "smooth", PAPER)
    correcting = write_network(tmp_path / "correcting.onnx", RESIDUAL, 2)
    with pytest.raises(OptionError, match="a network for the recipe residual, which corrects a faired fill"):
        repair_file(scan_file, output, correcting, PAPER)
    sized = RepairOptions(recipe="paper", dictionary=DictionaryOptions(atoms=30))
    with pytest.raises(OptionError, match="has its own"):
        repair_file(scan_file, output, dictionary_file(tmp_path, HEIGHTS), sized)
    with pytest.raises(OptionError, match=r"atoms and dictionary\.nonzero go with the model self"):
        repair_file(scan_file, output, write_network(tmp_path / "net.onnx", NETWORK, 1), sized)
    assert not output.exists()


@given(seed=st.integers(0, 2**32 - 1), n=st.integers(3, 40), m=st.integers(1, 80))
@settings(max_examples=15)
def test_heaps_of_random_triangles_are_repaired_unless_no_face_has_three_corners(
    tmp_path_factory: pytest.TempPathFactory, seed: int, n: int, m: int
) -> None:
    rng = np.random.default_rng(seed)
    vertices = rng.normal(size=(n, 3))
    mesh = TriangleMesh(vertices, rng.integers(0, n, (m, 3)))
    folder = tmp_path_factory.mktemp("heap")
    source, options = write_ply(folder / "in.ply", mesh), RepairOptions(HoleOptions(1e30), recipe="paper")
    if not has_a_face(mesh):
        with pytest.raises(EmptyMeshError):
            repair_file(source, folder / "out.ply", "self", options)
        return
    report = repair_file(source, folder / "out.ply", "self", options)
    json.dumps(report, allow_nan=False)
    after = read_scan(folder / "out.ply")
    assert np.isfinite(after.vertices).all()
    assert after.vertices[:n].tobytes() == vertices.tobytes()
