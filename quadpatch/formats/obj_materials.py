"""Material libraries of OBJ files: the image that gives each material its colour, and copies with a texture page.

A library in a file of its own is read only from the folder of the mesh or below it. Images are those of `map_Kd`, with
its options `-clamp`, `-o` and `-s`.

Tested in `tests/quadpatch/test_textured_fill.py`.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quadpatch.errors import TextureError
from quadpatch.formats.surface_texture import TextureImage, TexturePage, Wrap, image_beside, read_beside
from quadpatch.formats.text import decode_text
from quadpatch.types import FloatArray, IntArray

# Words behind the options of a map; -o, -s and -t take up to three numbers.
_N_WORDS = {b"-blendu": 1, b"-blendv": 1, b"-cc": 1, b"-clamp": 1, b"-texres": 1, b"-bm": 1, b"-boost": 1}
_N_WORDS |= {b"-imfchan": 1, b"-type": 1, b"-mm": 2}
_VECTORS = (b"-o", b"-s", b"-t")
_NUMBER = re.compile(rb"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d{1,3})?")
# Lines of a material that name images, which know nothing of a page.
_WITH_IMAGES = re.compile(rb"(map_\w+|bump|disp|decal|refl|norm)\b", re.IGNORECASE)


@dataclass(frozen=True)
class ObjMaterial:
    """One material of a library.

    Attributes
    ----------
    lines : tuple of bytes
        What stands behind its `newmtl`, without line ends.
    image : TextureImage or None
        Of its colour.
    scale, offset : (2,) float64
        From the coordinates of the mesh to those of the image.
    """

    lines: tuple[bytes, ...]
    image: TextureImage | None
    scale: FloatArray
    offset: FloatArray


def read_materials(libraries: Iterable[bytes], folder: Path | None) -> dict[bytes, ObjMaterial]:
    """Read the materials of the libraries that an OBJ file names, by their names.

    Parameters
    ----------
    libraries : iterable of bytes
        What stands behind `mtllib` in each such line: one name, or several.
    folder : Path or None
        Of the mesh; None allows no further files.

    Raises
    ------
    TextureError
        If one of the files is missing or too large.
    """
    found: dict[bytes, ObjMaterial] = {}
    for words in libraries:
        for text in _texts(words, folder):
            for name, lines in _blocks(text):
                # The first material of a name counts.
                found.setdefault(name, _material(lines, folder))
    return found


def _texts(words: bytes, folder: Path | None) -> list[bytes]:
    """Texts of the libraries that a line names: a name may hold spaces, and a line several names."""
    try:
        return [decode_text(read_beside(folder, _path(words)))[0]]
    except TextureError:
        names = words.split()
        if len(names) < 2:
            raise
    return [decode_text(read_beside(folder, _path(name)))[0] for name in names]


def _path(name: bytes) -> str:
    return name.decode("utf-8", "surrogateescape")


def _blocks(text: bytes) -> list[tuple[bytes, list[bytes]]]:
    """Names of materials, and the lines behind them."""
    blocks: list[tuple[bytes, list[bytes]]] = []
    for line in re.split(rb"[\r\n]+", text):
        keyword, _, rest = line.strip().partition(b" ")
        if keyword == b"newmtl":
            blocks.append((rest.strip(), []))
        elif blocks and keyword and not keyword.startswith(b"#"):
            blocks[-1][1].append(line.strip())
    return blocks


def _material(lines: Sequence[bytes], folder: Path | None) -> ObjMaterial:
    scale, offset = np.ones(2), np.zeros(2)
    image = None
    for line in lines:
        keyword, _, rest = line.replace(b"\t", b" ").partition(b" ")
        if keyword.lower() == b"map_kd":
            options, name = _options(rest.strip())
            wrap: Wrap = "clamp" if options.get(b"-clamp") == [b"on"] else "repeat"
            image = image_beside(folder, _path(name), (wrap, wrap)) if name else None
            scale, offset = _vector(options.get(b"-s"), 1.0), _vector(options.get(b"-o"), 0.0)
    return ObjMaterial(tuple(lines), image, scale, offset)


def _options(rest: bytes) -> tuple[dict[bytes, list[bytes]], bytes]:
    """Options of a map, and the name behind them, which may hold spaces."""
    options: dict[bytes, list[bytes]] = {}
    while rest.startswith(b"-"):
        word, _, behind = rest.partition(b" ")
        if word not in _N_WORDS and word not in _VECTORS:
            break
        values: list[bytes] = []
        while len(values) < _N_WORDS.get(word, 3):
            value, _, further = behind.lstrip().partition(b" ")
            if word in _VECTORS and not _NUMBER.fullmatch(value):
                break
            values.append(value)
            behind = further
        options[word], rest = values, behind.lstrip()
    return options, rest


def _vector(words: list[bytes] | None, default: float) -> FloatArray:
    numbers = [float(word) for word in words or []][:2]
    return np.array(numbers + [default] * (2 - len(numbers)))


def page_name(material: bytes, page: TexturePage) -> bytes:
    """Name of the copy of a material that has the page."""
    return material + b"_" + page.stem.encode()


def library_with_page(materials: Sequence[tuple[bytes, ObjMaterial]], page: TexturePage) -> bytes:
    """Write a library of copies of some materials, by their names, with a page in the place of their image."""
    lines = [b"# New surface, made by Quadpatch: the materials around it with a texture page of their own."]
    for name, material in materials:
        lines += [b"", b"newmtl " + page_name(name, page)]
        lines += [line for line in material.lines if not _WITH_IMAGES.match(line)]
        lines.append(b"map_Kd " + page.stem.encode() + b".png")
    return b"\n".join([*lines, b""])


def coordinates_in_images(coordinates: FloatArray, material: IntArray, found: Sequence[ObjMaterial]) -> FloatArray:
    """Take texture coordinates (m, 3, 2) of triangles of some materials (m,) to those of images."""
    scale, offset = (np.stack([*rows, neutral]) for rows, neutral in _rows(found))
    return coordinates * scale[material][:, np.newaxis] + offset[material][:, np.newaxis]


def _rows(found: Sequence[ObjMaterial]) -> list[tuple[list[FloatArray], FloatArray]]:
    return [([entry.scale for entry in found], np.ones(2)), ([entry.offset for entry in found], np.zeros(2))]
