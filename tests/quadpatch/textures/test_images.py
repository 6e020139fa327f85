import numpy as np
import pytest

from quadpatch.errors import ImageTooLargeError, ImageUnreadableError
from quadpatch.formats.surface_texture import TextureImage, Wrap
from quadpatch.textures import images
from quadpatch.textures.images import DecodedImage, size_of
from tests.quadpatch.formats.textured_files import encoded

PIXELS = np.arange(4 * 6 * 3, dtype=np.uint8).reshape(4, 6, 3) * 3


def image(data: bytes, wrap: tuple[Wrap, Wrap] = ("repeat", "repeat")) -> TextureImage:
    return TextureImage("wood.png", lambda: data, wrap)


def centres() -> np.ndarray:
    row, column = np.mgrid[:4, :6].reshape(2, -1)
    return np.stack([(column + 0.5) / 6, 1 - (row + 0.5) / 4], axis=1)


def test_the_middles_of_texels_have_their_colours() -> None:
    decoded = DecodedImage(image(encoded(PIXELS)))
    assert (decoded.width, decoded.height) == (6, 4)
    colours = decoded.colours_at(centres())
    assert (colours[:, :3] == PIXELS.reshape(-1, 3)).all()
    assert (colours[:, 3] == 255).all()


@pytest.mark.parametrize(
    ("wrap", "columns"), [("repeat", [4, 5, 0, 5, 0, 1]), ("clamp", [0, 0, 0, 5, 5, 5]), ("mirror", [1, 0, 0, 5, 5, 4])]
)
def test_beyond_the_border_an_image_goes_on_as_it_says(wrap: Wrap, columns: list[int]) -> None:
    decoded = DecodedImage(image(encoded(PIXELS), (wrap, "repeat")))
    places = np.stack([(np.array([-2, -1, 0, 5, 6, 7]) + 0.5) / 6, np.full(6, 1 - 0.5 / 4)], axis=1)
    assert (decoded.colours_at(places)[:, :3] == PIXELS[0, columns]).all()


def test_places_that_are_no_numbers_or_far_away_have_some_colour() -> None:
    decoded = DecodedImage(image(encoded(PIXELS)))
    assert np.isfinite(decoded.colours_at(np.array([[np.nan, 0.5], [1e300, -1e300], [np.inf, 0.0]]))).all()


def test_bands_make_no_difference(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(images, "_BAND", 3)
    assert (DecodedImage(image(encoded(PIXELS))).colours_at(centres())[:, :3] == PIXELS.reshape(-1, 3)).all()


def test_pixels_are_counted_before_they_are_decoded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(images, "MOST_PIXELS", 23)
    broken = encoded(PIXELS)[:60]
    with pytest.raises(ImageTooLargeError, match="24 pixels; the limit is 23"):
        size_of(image(broken))


def test_broken_data_are_found_when_they_are_decoded() -> None:
    broken = encoded(np.random.default_rng(0).integers(0, 255, (50, 50, 3)).astype(np.uint8))[:3000]
    assert size_of(image(broken)) == (50, 50)
    with pytest.raises(ImageUnreadableError, match="broken"):
        DecodedImage(image(broken))
