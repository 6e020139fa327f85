"""The cards of the networks that ship."""

import hashlib
from pathlib import Path

import pytest

from quadpatch.inpainters.model_file import SHIPPED_MODELS
from quadpatch.inpainters.onnx_network import AutoencoderInpainter

MAX_BYTES = 10 * 1024 * 1024
NETWORKS = sorted(SHIPPED_MODELS.glob("*.onnx"))


@pytest.mark.parametrize("path", NETWORKS, ids=lambda path: path.stem)
def test_a_shipped_network_is_small_and_its_page_is_about_these_very_bytes(path: Path) -> None:
    card, page = AutoencoderInpainter.load(path).card, path.with_suffix(".md").read_text("utf-8")
    assert path.stat().st_size < MAX_BYTES
    assert f"{card['name']}@{card['version']}" == path.stem
    assert page.startswith(f"# {path.stem}\n")
    for fact in (
        hashlib.sha256(path.read_bytes()).hexdigest(),
        card["corpus_sha256"],
        card["command"],
        card["licence"],
    ):
        assert fact in page
    assert f"| validation_loss | {card['metrics']['validation_loss']:g} |" in page


@pytest.mark.parametrize("path", NETWORKS, ids=lambda path: path.stem)
def test_a_shipped_network_learned_from_meshes_with_a_licence_and_none_that_it_is_measured_on(path: Path) -> None:
    card = AutoencoderInpainter.load(path).card
    trained, held_out = card["training_corpus"], card["held_out"]
    assert trained
    assert all(mesh["licence"] and mesh["sha256"] for mesh in trained + held_out)
    assert not {mesh["sha256"] for mesh in trained} & {mesh["sha256"] for mesh in held_out}
