"""Texture images of a surface, as files hold them: where they lie on it, and the bytes of each.

No image is decoded here. One in a file of its own is read only from the folder of the mesh or below it.

Tested in `tests/quadpatch/test_textured_fill.py`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Literal

from quadpatch.errors import ImageMissingError, ImageTooLargeError
from quadpatch.types import FloatArray, IntArray

# What stands beyond the border of an image: the same again, its mirror image, or the colours at its border.
Wrap = Literal["repeat", "mirror", "clamp"]
# No image of a texture that can be decoded (see `quadpatch.textures.images`) is as large.
MOST_BYTES = 1 << 30


@dataclass(frozen=True)
class TextureImage:
    """An image as a file names it.

    Attributes
    ----------
    name : str
        For messages.
    read : callable
        Returns the bytes; raises ImageMissingError or ImageTooLargeError.
    wrap : (str, str)
        Along u and v.
    """

    name: str
    read: Callable[[], bytes]
    wrap: tuple[Wrap, Wrap] = ("repeat", "repeat")


@dataclass(frozen=True)
class ImageProblem:
    """An image that could not be carried on: its name, a stable code, and a sentence."""

    image: str
    code: str
    message: str


@dataclass(frozen=True)
class SurfaceTexture:
    """Images on a surface.

    Attributes
    ----------
    coordinates : (m, 3, 2) float64
        Of every triangle's corners in its image: u to the right, v upwards, 0..1 once across; NaN for corners that
        have none.
    material : (m,) int64
        Material of every triangle, -1 for none.
    images : tuple of (TextureImage or None)
        Of each material: the one that gives its colour.
    """

    coordinates: FloatArray
    material: IntArray
    images: tuple[TextureImage | None, ...]


@dataclass(frozen=True)
class TexturePage:
    """An image for new triangles.

    Attributes
    ----------
    png : bytes
    coordinates : (l, 3, 2) float64
        Of every new triangle's corners, v upwards; NaN for triangles that are not on the page.
    material : (l,) int64
        Material of the measured surface that each new triangle goes on with, -1 for triangles that are not on the page.
    stem : str
        Name for files of its own, without suffix; no file of another content has it.
    """

    png: bytes
    coordinates: FloatArray
    material: IntArray
    stem: str


def image_beside(folder: Path | None, name: str, wrap: tuple[Wrap, Wrap] = ("repeat", "repeat")) -> TextureImage:
    """Name an image in a file of its own, which is not looked at before it is read."""
    return TextureImage(name, lambda: read_beside(folder, name), wrap)


def read_beside(folder: Path | None, name: str) -> bytes:
    """Read a file that a mesh names.

    Parameters
    ----------
    folder : Path or None
        Of the mesh; None allows no further files.
    name : str
        As the mesh has it. Where it leads out of the folder, as paths of another machine do, its last step is looked
        for in the folder.

    Raises
    ------
    ImageMissingError
        If no file of that name lies in the folder or below it.
    ImageTooLargeError
        If it has more than `MOST_BYTES` bytes.
    """
    steps = PurePosixPath(name.replace("\\", "/"))
    path = None if folder is None else _first_file(folder, [str(steps), steps.name])
    if path is None:
        raise ImageMissingError(f"there is no file {name[:80]!r} in the mesh's folder")
    try:
        size = path.stat().st_size
        if size > MOST_BYTES:
            raise ImageTooLargeError(f"{name[:80]!r} has {size:,} bytes; the limit is {MOST_BYTES:,}")
        return path.read_bytes()
    except OSError as error:
        raise ImageMissingError(f"{name[:80]!r} can't be read: {error.strerror}") from error


def _first_file(folder: Path, names: list[str]) -> Path | None:
    """Return the first of some names that is a file in a folder or below it."""
    for name in names:
        try:
            path = (folder / name).resolve()
            if path.is_relative_to(folder.resolve()) and path.is_file():
                return path
        except (OSError, ValueError):
            # A name that no file can have.
            continue
    return None
