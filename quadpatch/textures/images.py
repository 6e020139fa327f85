"""Texture images decoded within limits, and the colours at places of them.

Images are untrusted: their size is looked at before they are decoded, only common formats are, and whatever else a
decoder raises makes the image an unreadable one.
"""

import io
import struct
import warnings
import zlib

import numpy as np
from PIL import BmpImagePlugin, Image, JpegImagePlugin, PngImagePlugin, TiffImagePlugin, WebPImagePlugin

from quadpatch.errors import ImageTooLargeError, ImageUnreadableError
from quadpatch.formats.surface_texture import TextureImage, Wrap
from quadpatch.types import FloatArray, IntArray

# Named by their decoders, so that these are loaded: an engine that is confined can't load them any more.
_DECODERS = (PngImagePlugin, JpegImagePlugin, WebPImagePlugin, TiffImagePlugin, BmpImagePlugin)
_FORMATS = ("PNG", "JPEG", "WEBP", "TIFF", "BMP")
# Pixels of one image, which are all decoded at once.
MOST_PIXELS = 1 << 27
# Rows that are looked at together, so that a large image is not copied as a whole.
_BAND = 512
# Modes that are shown as they are; all others are converted.
_PLAIN = ("RGB", "RGBA")
_DEEP = ("I", "I;16", "I;16L", "I;16B", "I;16N")
# What decoders raise on broken data.
_BROKEN = (
    ArithmeticError,
    AttributeError,
    EOFError,
    LookupError,
    OSError,
    RuntimeError,
    SyntaxError,
    TypeError,
    ValueError,
    struct.error,
    zlib.error,
)


class DecodedImage:
    """An image of bytes, red, green, blue and alpha.

    Parameters
    ----------
    image : TextureImage

    Attributes
    ----------
    width, height : int
    has_alpha : bool

    Raises
    ------
    TextureError
        ImageMissingError, ImageUnreadableError or ImageTooLargeError.
    """

    def __init__(self, image: TextureImage) -> None:
        self._wrap = image.wrap
        self._pixels = _decode(image.read())
        self.width, self.height = self._pixels.size
        self.has_alpha = self._pixels.mode == "RGBA"

    def colours_at(self, coordinates: FloatArray) -> FloatArray:
        """Colours (k, 4) of the texels that places (k, 2) lie in, 0..255; v upwards. Of opaque images alpha is 255."""
        column = _wrapped(np.floor(coordinates[:, 0] * self.width), self.width, self._wrap[0])
        row = _wrapped(np.floor((1.0 - coordinates[:, 1]) * self.height), self.height, self._wrap[1])
        colours = np.full((len(column), 4), 255.0)
        order = np.argsort(row, kind="stable")
        tops = range(0, self.height, _BAND)
        # Loops over bands of rows.
        for top, members in zip(tops, np.split(order, np.searchsorted(row[order], np.array(tops[1:]))), strict=True):
            if len(members):
                band = np.asarray(self._pixels.crop((0, top, self.width, min(top + _BAND, self.height))))
                colours[members, : band.shape[2]] = band[row[members] - top, column[members]]
        return colours


def size_of(image: TextureImage) -> tuple[int, int]:
    """Width and height of an image that is not decoded; raises as `DecodedImage`."""
    return _opened(image.read()).size


def _opened(data: bytes) -> Image.Image:
    try:
        with warnings.catch_warnings():
            # Our own limit stands in the place of Pillow's, and what it finds odd in tags does not matter.
            warnings.simplefilter("ignore")
            opened = Image.open(io.BytesIO(data), formats=_FORMATS)
    except Image.DecompressionBombError as error:
        raise ImageTooLargeError(f"it has more than {MOST_PIXELS:,} pixels, the limit") from error
    except _BROKEN as error:
        raise ImageUnreadableError(f"it is no {', '.join(_FORMATS)} image that can be read") from error
    n_pixels = opened.size[0] * opened.size[1]
    if n_pixels > MOST_PIXELS:
        raise ImageTooLargeError(f"it has {n_pixels:,} pixels; the limit is {MOST_PIXELS:,}")
    if not n_pixels:
        raise ImageUnreadableError("it has no pixel")
    return opened


def _decode(data: bytes) -> Image.Image:
    opened = _opened(data)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            opened.load()
            return _as_bytes(opened)
    except _BROKEN as error:
        raise ImageUnreadableError("its data are broken or end too early") from error


def _as_bytes(image: Image.Image) -> Image.Image:
    """Bring an image to red, green and blue, with alpha where it has any."""
    if image.mode in _PLAIN:
        return image
    if image.mode in _DEEP:
        # Of sixteen bits the upper eight; Pillow would cut off at 255.
        image = Image.fromarray((np.asarray(image).astype(np.float64) / 256).clip(0, 255).astype(np.uint8))
    has_alpha = "A" in image.getbands() or "transparency" in image.info
    return image.convert("RGBA" if has_alpha else "RGB")


def _wrapped(texel: FloatArray, n: int, wrap: Wrap) -> IntArray:
    """Bring texels (k,) into an image that is n wide."""
    whole = np.nan_to_num(texel).clip(-(2.0**52), 2.0**52).astype(np.int64)
    if wrap == "clamp":
        return np.asarray(whole.clip(0, n - 1))
    if wrap == "mirror":
        folded = whole % (2 * n)
        return np.asarray(np.minimum(folded, 2 * n - 1 - folded))
    return np.asarray(whole % n)
