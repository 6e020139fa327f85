"""Texture images of PLY files, as MeshLab and its kin write them.

Comments `TextureFile NAME` name them, a list `texcoord` holds the coordinates of each face's corners, and where there
are several, `texnumber` the number of its image.

Tested in `tests/quadpatch/test_textured_fill.py`.
"""

from pathlib import Path

import numpy as np

from quadpatch.errors import TextureError
from quadpatch.formats.ply.file import PlyFile
from quadpatch.formats.ply.vertex_attributes import has_vertex_texture, wedge_texture
from quadpatch.formats.surface_texture import SurfaceTexture, TexturePage, image_beside
from quadpatch.types import IntArray

NUMBER = "texnumber"
_KEYWORD = b"TextureFile"


def texture_names(file: PlyFile) -> list[str]:
    """Names of images in the header."""
    names = []
    for line in file.header.lines:
        words = line.strip().split(None, 2)
        if len(words) == 3 and words[0] == b"comment" and words[1].lower() == _KEYWORD.lower():
            names.append(words[2].decode("utf-8", "surrogateescape"))
    return names


def ply_surface_texture(file: PlyFile, folder: Path | None) -> SurfaceTexture | None:
    """Find the images on the faces of a file; None for none.

    Raises
    ------
    TextureError
        If texture coordinates belong to vertices, so that a rim vertex can't lie in a page as well.
    """
    names, rows = texture_names(file), file.element(file.carrier)
    coordinates = None if rows is None or file.carrier != "face" else wedge_texture(rows, file.triangle_row)
    if not names:
        return None
    if coordinates is None:
        if has_vertex_texture(file):
            raise TextureError("the PLY file has texture coordinates of vertices, not of the corners of faces")
        return None
    number = _numbers(file, len(names))
    return SurfaceTexture(coordinates, number, tuple(image_beside(folder, name) for name in names))


def _numbers(file: PlyFile, n_images: int) -> IntArray:
    """Image of each triangle (m,), -1 for numbers that no image has."""
    rows = file.element("face")
    column = None if rows is None else rows.scalar(NUMBER)
    if column is None:
        return np.where(file.triangle_row >= 0, 0, -1)
    number = np.nan_to_num(column.astype(np.float64), nan=-1.0)[np.maximum(file.triangle_row, 0)]
    is_known = (file.triangle_row >= 0) & (number >= 0) & (number < n_images)
    return np.where(is_known, number, -1).astype(np.int64)


def page_file(page: TexturePage) -> str:
    """Name of the file of a page."""
    return f"{page.stem}.png"


def page_comment(page: TexturePage, line_end: bytes) -> bytes:
    """Header line that names a page; it stands behind those of other images, and has the next number."""
    return b"comment " + _KEYWORD + b" " + page_file(page).encode() + line_end
