from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from benchmarks import learned_picture


def test_the_damaged_relief_and_both_fills_are_drawn_beside_each_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(learned_picture, "_N_SIDE", 50)
    monkeypatch.setattr(learned_picture, "_WAVES", 3)
    learned_picture.draw(tmp_path / "learned.png")
    sheet = np.asarray(Image.open(tmp_path / "learned.png").convert("RGB"), np.float64)
    tiles = [sheet[26:, left : left + 420] for left in (0, 428, 856)]
    # Invented surface is orange: more red than blue.
    orange = [float((tile[..., 0] - tile[..., 2] > 25).mean()) for tile in tiles]
    assert orange[0] == 0
    assert min(orange[1:]) > 0.02
