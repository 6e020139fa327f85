"""Images of base colours in glTF: where they lie, and materials with a texture page.

Read are the textures of the metallic-roughness model, with `KHR_texture_transform`, and `EXT_texture_webp`. Images lie
in the file, or beside it.

Tested in `tests/quadpatch/test_textured_fill.py`.
"""

import base64
import binascii
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

import numpy as np

from quadpatch.errors import ImageMissingError, ReadError
from quadpatch.formats.gltf.accessors import get_count, get_entry, get_list, get_object
from quadpatch.formats.gltf.container import GltfFile
from quadpatch.formats.gltf.primitive import Store
from quadpatch.formats.scan import Scan
from quadpatch.formats.surface_texture import (
    SurfaceTexture,
    TextureImage,
    TexturePage,
    Wrap,
    image_beside,
)
from quadpatch.types import FloatArray

if TYPE_CHECKING:
    from quadpatch.formats.gltf.source import Primitive

_PBR, _BASE = "pbrMetallicRoughness", "baseColorTexture"
_WRAPS: dict[int, Wrap] = {10497: "repeat", 33648: "mirror", 33071: "clamp"}
# Of a material that goes on with a page; all else may name images that know nothing of the page.
_KEPT = ("name", "alphaMode", "alphaCutoff", "doubleSided", "extras")
_KEPT_EXTENSIONS = ("KHR_materials_unlit",)
_LINEAR, _LINEAR_MIPMAP_LINEAR, _CLAMP = 9729, 9987, 33071


def gltf_surface_texture(file: GltfFile, primitives: "Sequence[Primitive]", scan: Scan) -> SurfaceTexture | None:
    """Find the images of base colours; a material is one entry of the document's list."""
    listed = get_list(file.document, "materials")
    infos = [_base_texture(entry) for entry in listed]
    images: list[TextureImage | None] = [None if info is None else _image(file, info) for info in infos]
    coordinates = np.full((len(scan.triangles), 3, 2), np.nan)
    material = np.full(len(scan.triangles), -1)
    for primitive in primitives:
        number = primitive.material
        if not isinstance(number, int) or not 0 <= number < len(images) or images[number] is None:
            continue
        info = infos[number] or {}
        values = primitive.attributes.get(f"TEXCOORD_{_coordinate_set(info)}")
        if values is None:
            continue
        rows = slice(primitive.triangles[0], sum(primitive.triangles))
        placed = _transformed(values, info) * np.array([1.0, -1.0]) + np.array([0.0, 1.0])
        coordinates[rows] = placed[scan.triangles[rows] - primitive.vertices[0]]
        material[rows] = number
    return SurfaceTexture(coordinates, material, tuple(images)) if (material >= 0).any() else None


def coordinate_sets(document: dict[str, Any], material: object) -> list[str]:
    """Names of the attributes that hold texture coordinates which matter for a material."""
    listed = document.get("materials")
    known = isinstance(material, int) and isinstance(listed, list) and 0 <= material < len(listed)
    info = _base_texture(listed[material]) if known and isinstance(material, int) and listed else None
    return sorted({"TEXCOORD_0", f"TEXCOORD_{_coordinate_set(info or {})}"})


def _base_texture(material: object) -> dict[str, Any] | None:
    """Return what a material says of its base colour's texture, None where it has none."""
    pbr = material.get(_PBR) if isinstance(material, dict) else None
    info = pbr.get(_BASE) if isinstance(pbr, dict) else None
    return info if isinstance(info, dict) else None


def _transform(info: dict[str, Any]) -> dict[str, Any]:
    extensions = info.get("extensions")
    found = extensions.get("KHR_texture_transform") if isinstance(extensions, dict) else None
    return found if isinstance(found, dict) else {}


def _coordinate_set(info: dict[str, Any]) -> int:
    value = _transform(info).get("texCoord", info.get("texCoord", 0))
    return value if isinstance(value, int) and 0 <= value < 16 else 0


def _transformed(coordinates: FloatArray, info: dict[str, Any]) -> FloatArray:
    """Texture coordinates (k, 2), v downwards, in the image: scaled, turned, shifted."""
    transform = _transform(info)
    if not transform:
        return coordinates
    angle = float(_numbers(transform.get("rotation"), 1, 0.0)[0])
    cosine, sine = np.cos(angle), np.sin(angle)
    scaled = coordinates * _numbers(transform.get("scale"), 2, 1.0)
    turned = scaled @ np.array([[cosine, -sine], [sine, cosine]])
    return np.asarray(turned + _numbers(transform.get("offset"), 2, 0.0))


def _numbers(value: object, n: int, default: float) -> FloatArray:
    values = value if isinstance(value, list) else [value]
    is_right = len(values) == n and all(isinstance(word, int | float) and abs(word) < 1e9 for word in values)
    return np.array(values if is_right else [default] * n, dtype=np.float64)


def _image(file: GltfFile, info: dict[str, Any]) -> TextureImage:
    """Name the image of a texture; what is wrong with it is told when it is read."""
    document = file.document
    try:
        texture = get_entry(document, "textures", info.get("index"))
        sampler = get_entry(document, "samplers", texture["sampler"]) if "sampler" in texture else {}
        webp = get_object(get_object(texture, "extensions"), "EXT_texture_webp")
        entry = get_entry(document, "images", webp.get("source", texture.get("source")))
        wrap = tuple(_WRAPS.get(sampler.get(key, 10497), "repeat") for key in ("wrapS", "wrapT"))
    except (ReadError, TypeError) as error:
        message = str(error)
        return TextureImage("of a material", lambda: _missing(message))
    number = get_list(document, "images").index(entry)
    uri = entry.get("uri")
    if isinstance(uri, str) and not uri.startswith("data:"):
        return image_beside(file.folder, unquote(uri), (wrap[0], wrap[1]))
    name = str(entry.get("name") or f"image {number}")[:80]
    return TextureImage(name, lambda: _embedded(file, entry), (wrap[0], wrap[1]))


def _missing(message: str) -> bytes:
    raise ImageMissingError(message)


def _embedded(file: GltfFile, entry: dict[str, Any]) -> bytes:
    """Return the bytes of an image in the document, or in one of its buffers."""
    try:
        if isinstance(entry.get("uri"), str):
            return base64.b64decode(str(entry["uri"]).partition(";base64,")[2], validate=True)
        view = get_entry(file.document, "bufferViews", entry.get("bufferView"))
        data = file.buffers[get_count(view, "buffer")]
        start = get_count(view, "byteOffset", 0)
        return data[start : start + get_count(view, "byteLength")]
    except (ReadError, IndexError, binascii.Error, ValueError) as error:
        raise ImageMissingError(f"the glTF document does not hold it: {error}") from error


def add_page_materials(store: Store, page: TexturePage) -> dict[int, object]:
    """Add a page to a document, and a copy of each material that goes on with it: new numbers by the old ones."""
    view = store.add_bytes(page.png)
    image = store.add("images", {"name": page.stem, "mimeType": "image/png", "bufferView": view})
    filters = {"magFilter": _LINEAR, "minFilter": _LINEAR_MIPMAP_LINEAR, "wrapS": _CLAMP, "wrapT": _CLAMP}
    texture = store.add("textures", {"source": image, "sampler": store.add("samplers", filters)})
    materials: dict[int, object] = {}
    for number in sorted({*page.material.tolist()} - {-1}):
        materials[number] = store.add("materials", _with_page(store.document["materials"][number], texture))
    return materials


def _with_page(material: dict[str, Any], texture: int) -> dict[str, Any]:
    """Copy a material with the page for its base colour; what other images gave is left out."""
    old = material[_PBR]
    pbr: dict[str, Any] = {key: old[key] for key in ("baseColorFactor",) if key in old}
    # The factors multiply an image that is left out: alone they would make a mirror of what is dull.
    has_image = "metallicRoughnessTexture" in old
    plain = {"metallicFactor": 0.0, "roughnessFactor": 1.0} if has_image else old
    pbr |= {key: plain[key] for key in ("metallicFactor", "roughnessFactor") if key in plain}
    copied = {key: material[key] for key in _KEPT if key in material}
    if "emissiveTexture" not in material and "emissiveFactor" in material:
        copied["emissiveFactor"] = material["emissiveFactor"]
    extensions = material.get("extensions")
    kept = (
        {key: extensions[key] for key in _KEPT_EXTENSIONS if key in extensions} if isinstance(extensions, dict) else {}
    )
    return {**copied, **({"extensions": kept} if kept else {}), _PBR: {**pbr, _BASE: {"index": texture}}}
