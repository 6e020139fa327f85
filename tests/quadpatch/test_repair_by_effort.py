"""Repairs by the model `auto`, which is the default, with each effort."""

import sys
from pathlib import Path

import pytest

from quadpatch.errors import OptionError
from quadpatch.formats.reading import read_scan
from quadpatch.inpainters.competing import CompetingInpainters
from quadpatch.model_choice import AUTO, BASE_NETWORK, SELF, SELF_NETWORK, choose_model
from quadpatch.options import NetworkOptions, PatchOptions, RepairOptions
from quadpatch.progress import no_progress
from quadpatch.repair import repair_file
from quadpatch_rules.option_words import Effort
from tests.quadpatch.shapes import punched, relief, write_ply

SCAN = punched(relief(100, 2.0, 0.03, 10), *[(x, y, 0.0) for x in (-0.5, 0.5) for y in (-0.45, 0.5)], radius=0.1)


@pytest.fixture(scope="module")
def scan_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_ply(tmp_path_factory.mktemp("scan") / "relief.ply", SCAN)


@pytest.fixture
def without_torch(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let every import of torch fail, as where it is not installed."""
    monkeypatch.setitem(sys.modules, "torch", None)
    for name in [name for name in sys.modules if name.startswith("quadpatch.networks.")]:
        monkeypatch.delitem(sys.modules, name)


def test_by_default_models_compete_and_the_report_has_every_trial(scan_file: Path, tmp_path: Path) -> None:
    report = repair_file(scan_file, tmp_path / "out.ply")
    model = report["model"]
    assert (model["name"], model["effort"], report["options"]["effort"]) == (AUTO, "standard", "standard")
    geometry, *others = model["trials"]
    assert (geometry["models"], geometry["believed_share"]) == ({}, 0.0)
    halves = {SELF: 0.5, BASE_NETWORK: 0.5}
    assert [trial["models"] for trial in others] == [{SELF: 1.0}, {BASE_NETWORK: 1.0}, halves]
    # In mesh units: the relief is 0.03 high.
    assert 0.0 < geometry["error"] < 0.03
    for trial in others:
        assert (trial["error"] < geometry["error"]) == (trial["believed_share"] > 0.0)
    winner = min(others, key=lambda trial: trial["error"])
    assert winner["believed_share"] > 0.0
    assert (model["shares"], report["patches"]["believed_share"]) == (winner["models"], winner["believed_share"])
    assert report["counts"]["filled"] > 0
    again = repair_file(scan_file, tmp_path / "again.ply", AUTO)
    assert again["model"] == model
    assert (tmp_path / "again.ply").read_bytes() == (tmp_path / "out.ply").read_bytes()


def test_the_effort_fast_gives_the_bytes_of_geometry_alone(scan_file: Path, tmp_path: Path) -> None:
    report = repair_file(scan_file, tmp_path / "fast.ply", options=RepairOptions(effort="fast"))
    repair_file(scan_file, tmp_path / "smooth.ply", "smooth")
    assert report["model"] == {"name": AUTO, "effort": "fast"}
    assert report["patches"] is None
    assert (tmp_path / "fast.ply").read_bytes() == (tmp_path / "smooth.ply").read_bytes()


@pytest.mark.usefixtures("without_torch")
def test_without_torch_the_effort_best_says_what_was_not_tried_and_repairs(scan_file: Path, tmp_path: Path) -> None:
    report = repair_file(scan_file, tmp_path / "best.ply", options=RepairOptions(effort="best"))
    model = report["model"]
    assert list(model["not_tried"]) == [SELF_NETWORK]
    assert "needs torch, which is not installed here" in model["not_tried"][SELF_NETWORK]
    assert [list(trial["models"]) for trial in model["trials"]] == [[], [SELF], [BASE_NETWORK], [SELF, BASE_NETWORK]]
    repair_file(scan_file, tmp_path / "standard.ply")
    assert (tmp_path / "best.ply").read_bytes() == (tmp_path / "standard.ply").read_bytes()
    assert len(read_scan(tmp_path / "best.ply").triangles) > len(SCAN.triangles)


@pytest.mark.parametrize("patches", [PatchOptions(resolution=18), PatchOptions(preset="type2")])
@pytest.mark.parametrize(("effort", "networks"), [("standard", [BASE_NETWORK]), ("best", [BASE_NETWORK, SELF_NETWORK])])
def test_networks_with_other_patches_than_those_asked_for_are_left_out_and_named(
    patches: PatchOptions, effort: Effort, networks: list[str]
) -> None:
    inpainter, facts = choose_model(AUTO, RepairOptions(patches=patches, effort=effort), no_progress, None)
    assert isinstance(inpainter, CompetingInpainters)
    assert list(inpainter.members) == [SELF]
    bins = patches.resolution or 24
    assert facts["not_tried"] == dict.fromkeys(networks, f"its patches have 32 bins along a side, not {bins}")


def test_a_resolution_that_the_networks_have_lets_them_compete() -> None:
    options = RepairOptions(patches=PatchOptions(resolution=32))
    inpainter, facts = choose_model(AUTO, options, no_progress, None)
    assert isinstance(inpainter, CompetingInpainters)
    assert list(inpainter.members) == [SELF, BASE_NETWORK]
    assert facts == {"name": AUTO, "effort": "standard"}


def test_the_default_of_the_recipe_paper_is_a_dictionary_of_the_mesh() -> None:
    _, facts = choose_model(None, RepairOptions(recipe="paper"), no_progress, None)
    assert facts == {"name": SELF}


@pytest.mark.parametrize("model", ["smooth", SELF, SELF_NETWORK, BASE_NETWORK])
@pytest.mark.parametrize("effort", ["fast", "best"])
def test_an_effort_goes_with_auto_only(model: str, effort: Effort) -> None:
    with pytest.raises(OptionError, match="effort goes with the model auto only"):
        choose_model(model, RepairOptions(effort=effort), no_progress, None)


@pytest.mark.parametrize("effort", ["fast", "standard"])
def test_of_the_efforts_only_best_fits_a_network(effort: Effort) -> None:
    options = RepairOptions(effort=effort, network=NetworkOptions(steps=5))
    with pytest.raises(OptionError, match="with the effort best of auto, only"):
        choose_model(AUTO, options, no_progress, None)


def test_an_unknown_effort_is_refused() -> None:
    with pytest.raises(OptionError, match="effort must be one of fast, standard, best; it is 'most'"):
        RepairOptions(effort="most")  # type: ignore[arg-type]
