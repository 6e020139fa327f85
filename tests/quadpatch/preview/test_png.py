import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from quadpatch.preview.png import png_bytes, to_pixels, write_png


@pytest.mark.parametrize("size", [(1, 1), (1, 5), (7, 1), (64, 33)])
def test_a_picture_is_read_as_it_was_written(size: tuple[int, int]) -> None:
    pixels = np.random.default_rng(0).integers(0, 256, (size[1], size[0], 3)).astype(np.uint8)
    with Image.open(io.BytesIO(png_bytes(Image.fromarray(pixels)))) as image:
        assert (image.format, image.mode, image.size) == ("PNG", "RGB", size)
        # Pillow checks the sums of all parts on the way.
        np.testing.assert_array_equal(np.asarray(image), pixels)


def test_even_surfaces_take_few_bytes(tmp_path: Path) -> None:
    slope = np.tile(np.linspace(0, 1, 500)[:, None], (400, 1, 3))
    write_png(tmp_path / "slope.png", Image.fromarray(to_pixels(slope)))
    assert (tmp_path / "slope.png").stat().st_size < slope.size / 20
