import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from quadpatch.errors import OptionError
from training.curve import text_curve, write_curve


def test_the_text_curve_falls_with_the_error() -> None:
    assert text_curve(np.array([1.0, 0.75, 0.5])) == "1.0000 █▅▁ 0.5000"
    assert text_curve(np.zeros(3)) == "0.0000 ▁▁▁ 0.0000"
    assert text_curve(np.zeros(0)) == ""


def test_a_json_curve_holds_the_errors(tmp_path: Path) -> None:
    write_curve(tmp_path / "c.json", np.array([0.5, 0.25]))
    assert json.loads((tmp_path / "c.json").read_text()) == {"rms_error": [0.5, 0.25]}


@pytest.mark.parametrize("n", [0, 1, 15])
def test_a_png_curve_is_a_picture(tmp_path: Path, n: int) -> None:
    write_curve(tmp_path / "c.png", np.linspace(1.0, 0.5, n))
    with Image.open(tmp_path / "c.png") as image:
        assert len(image.convert("RGB").getcolors() or []) > 1


def test_another_suffix_is_refused(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"c\.gif"):
        write_curve(tmp_path / "c.gif", np.ones(3))
