"""PNG files, as ISO/IEC 15948 has them."""

import struct
import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from quadpatch.formats.output_files import write_whole
from quadpatch.preview.sampling import Colours
from quadpatch.types import FloatArray

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
# The type of the colours, and of the filter of a row.
_RGB, _SUB = 2, 1
# Of zlib: at 4 a picture is a sixth smaller and takes half as long again.
_LEVEL = 2


def to_pixels(picture: FloatArray | Colours) -> NDArray[np.uint8]:
    """Turn colours (rows, columns, 3) of 0..1 into bytes."""
    return np.asarray(np.round(picture * 255).astype(np.uint8))


def write_png(path: Path, image: Image.Image) -> None:
    """Write a picture that appears whole or not at all; raise OSError."""
    write_whole(path, png_bytes(image))


def png_bytes(image: Image.Image) -> bytes:
    """Encode a picture of red, green and blue.

    Pillow tries five filters on each row, which takes longer than to compress it, and loads its other formats first.
    """
    rows = np.asarray(image).reshape(image.height, -1)
    filtered = np.empty((image.height, 1 + rows.shape[1]), dtype=np.uint8)
    filtered[:, 0] = _SUB
    # The first pixel of a row, and the differences of the others from the one on their left, modulo 256.
    filtered[:, 1:4] = rows[:, :3]
    np.subtract(rows[:, 3:], rows[:, :-3], out=filtered[:, 4:])
    header = struct.pack(">IIBBBBB", image.width, image.height, 8, _RGB, 0, 0, 0)
    data = zlib.compress(filtered.data, _LEVEL)
    return _SIGNATURE + _chunk(b"IHDR", header) + _chunk(b"IDAT", data) + _chunk(b"IEND", b"")


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
