from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from quadpatch.errors import ModelError
from quadpatch.inpainters.model_file import load_model, save_dictionary, shipped_model
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.views.model_pictures import draw_model, model_picture


def test_every_atom_has_a_tile_in_the_order_of_the_file(tmp_path: Path) -> None:
    atoms = np.eye(16)[:, [0, 5, 10, 15, 3]]
    save_dictionary(tmp_path / "corners.safetensors", Dictionary(atoms, 4, 2), {})
    picture = np.array(model_picture(tmp_path / "corners.safetensors"))
    side = (picture.shape[1] - 3) // 3 - 3
    for i, bin_ in enumerate((0, 5, 10, 15, 3)):
        top, left = 3 + i // 3 * (side + 3), 3 + i % 3 * (side + 3)
        tile = picture[top : top + side, left : left + side]
        middles = ((np.arange(4) + 0.5) * side / 4).astype(int)
        assert np.flatnonzero(tile[np.ix_(middles, middles)] == 255).tolist() == [bin_]
    assert (picture[-side:, -side:] == 255).all()


@pytest.mark.parametrize("name", ["general-dictionary", "general-residual", "general-small_4x"])
def test_models_that_ship_are_drawn(tmp_path: Path, name: str) -> None:
    draw_model(shipped_model(name), tmp_path / "model.png")
    with Image.open(tmp_path / "model.png") as picture:
        assert 600 < picture.width <= 1200
        assert np.array(picture).std() > 20
    model = load_model(shipped_model(name))
    assert (tmp_path / "model.png").stat().st_size > (100_000 if model.dictionary else 5_000)


def test_what_is_no_model_is_not_drawn(tmp_path: Path) -> None:
    (tmp_path / "x.onnx").write_bytes(b"no network")
    with pytest.raises(ModelError):
        draw_model(tmp_path / "x.onnx", tmp_path / "x.png")
