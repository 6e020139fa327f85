"""Texture images of 3MF packages: where they lie, and pages added to them.

Read are groups of texture coordinates of the materials extension; multi-properties and composites are not.

Tested in `tests/quadpatch/test_textured_fill.py`.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from quadpatch.errors import ImageMissingError, ReadError
from quadpatch.formats.surface_texture import SurfaceTexture, TextureImage, TexturePage, Wrap
from quadpatch.formats.text import to_words
from quadpatch.formats.threemf.model import Model, ModelObject, TextureGroup
from quadpatch.formats.threemf.package import Package
from quadpatch.types import FloatArray, IntArray

_MATERIAL = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
_RELATION = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dtexture"
_RELATIONS = "http://schemas.openxmlformats.org/package/2006/relationships"
_TYPES = "[Content_Types].xml"
_WRAPS: dict[str, Wrap] = {"wrap": "repeat", "mirror": "mirror", "clamp": "clamp", "none": "clamp"}
_ID = re.compile(rb"""\bid\s*=\s*["']([0-9]{1,9})["']""")
_WORD = re.compile(r"[-+]?[0-9]*\.?[0-9]+([eE][-+]?[0-9]{1,3})?")


@dataclass(frozen=True)
class _Group:
    """A group of coordinates of a model part: its image, and a table (n, 2) with NaN for what is no number."""

    image: TextureImage
    table: FloatArray


def threemf_surface_texture(
    package: Package, models: Mapping[str, Model], entries: Sequence[tuple[str, ModelObject, bool]]
) -> SurfaceTexture | None:
    """Find the images on the triangles of some objects; a material is a group of a model part.

    Parameters
    ----------
    package : Package
    models : mapping
        By path.
    entries : sequence of (str, ModelObject, bool)
        Path of the model part, the object, and whether its triangles are turned over.
    """
    # By their ids: a page stands in front of what uses it, and has the highest.
    keys = [(path, group) for path, model in models.items() for group in sorted(model.texture_groups, key=_id_order)]
    groups = [_group(package, models[path], models[path].texture_groups[group]) for path, group in keys]
    number = {key: i for i, key in enumerate(keys)}
    tables = [_on_object(path, entry, is_turned, number, groups) for path, entry, is_turned in entries]
    if not groups or not tables:
        return None
    coordinates, material = (np.concatenate(rows) for rows in zip(*tables, strict=True))
    if not (material >= 0).any():
        return None
    return SurfaceTexture(coordinates, material, tuple(group.image for group in groups))


def _id_order(name: str) -> tuple[int, str]:
    return (int(name) if name.isdecimal() and len(name) < 10 else -1, name)


def _group(package: Package, model: Model, group: TextureGroup) -> _Group:
    flat = [word if _WORD.fullmatch(word) else "nan" for pair in group.coordinates for word in pair]
    table = np.array(flat, dtype=np.float64).reshape(-1, 2)
    image = model.images.get(group.image_id)
    path = "" if image is None else image.path.lstrip("/")
    wrap = ("wrap", "wrap") if image is None else (image.tile_u, image.tile_v)
    wraps: tuple[Wrap, Wrap] = (_WRAPS.get(wrap[0], "repeat"), _WRAPS.get(wrap[1], "repeat"))
    return _Group(TextureImage(path[:80], lambda: _read(package, path), wraps), table)


def _read(package: Package, path: str) -> bytes:
    try:
        return package.read(path)
    except ReadError as error:
        raise ImageMissingError(str(error)) from error


def _on_object(
    path: str, entry: ModelObject, is_turned: bool, number: Mapping[tuple[str, str], int], groups: Sequence[_Group]
) -> tuple[FloatArray, IntArray]:
    coordinates = np.full((len(entry.triangles), 3, 2), np.nan)
    material = np.full(len(entry.triangles), -1)
    # Loops over triangles.
    for row, (pid, *indices) in enumerate(entry.properties):
        found = number.get((path, pid or entry.default_pid or ""))
        first = indices[0] or (None if pid else entry.default_index)
        if found is None or first is None:
            continue
        corners = [first, indices[1] or first, indices[2] or first]
        table = groups[found].table
        if all(word.isdecimal() and len(word) < 10 and int(word) < len(table) for word in corners):
            coordinates[row] = table[[int(word) for word in corners]]
            material[row] = found
    return (coordinates[:, [0, 2, 1]] if is_turned else coordinates), material


def free_id(text: bytes) -> int:
    """Return an id that nothing in a model part has, nor any above it."""
    return 1 + max([0, *map(int, _ID.findall(text))])


def page_resources(coordinates: FloatArray, page: TexturePage, first_id: int) -> str:
    """Elements of a page, with the ids from `first_id` on, and of its coordinates (n, 2)."""
    u, v = (to_words(column) for column in coordinates.T)
    places = "".join(f'<m:tex2coord u="{a}" v="{b}"/>' for a, b in zip(u, v, strict=True))
    rest = 'contenttype="image/png" tilestyleu="clamp" tilestylev="clamp"'
    return (
        f'<m:texture2d xmlns:m="{_MATERIAL}" id="{first_id}" path="/{page_path(page)}" {rest}/>'
        f'<m:texture2dgroup xmlns:m="{_MATERIAL}" id="{first_id + 1}" texid="{first_id}">{places}</m:texture2dgroup>'
    )


def page_path(page: TexturePage) -> str:
    """Path of the entry of a page."""
    return f"3D/Textures/{page.stem}.png"


def entries_of_page(package: Package, page: TexturePage, model_paths: Sequence[str]) -> dict[str, bytes]:
    """Entries that a page needs besides the model parts that use it: itself, relationships, and its type."""
    entries = {page_path(page): page.png}
    relation = f'<Relationship xmlns="{_RELATIONS}" Target="/{page_path(page)}" Id="{page.stem}" Type="{_RELATION}"/>'
    for path in model_paths:
        folder, _, name = path.rpartition("/")
        target = f"{folder}/_rels/{name}.rels".lstrip("/")
        empty = f'<?xml version="1.0" encoding="UTF-8"?>\n<Relationships xmlns="{_RELATIONS}"></Relationships>'.encode()
        old = package.read(target) if target in package.names else empty
        entries[target] = _inside(old, relation)
    if _TYPES in package.names:
        types = package.read(_TYPES)
        if not re.search(rb"""Extension\s*=\s*["']png["']""", types, re.IGNORECASE):
            namespace = "http://schemas.openxmlformats.org/package/2006/content-types"
            entries[_TYPES] = _inside(types, f'<Default xmlns="{namespace}" Extension="png" ContentType="image/png"/>')
    return entries


def _inside(text: bytes, element: str) -> bytes:
    """Put an element in front of the last closing tag of an XML text; one whose root is empty gets no element."""
    at = text.rfind(b"</")
    return text[:at] + element.encode() + text[at:] if at >= 0 else text
