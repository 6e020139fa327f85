"""One model part of a 3MF package: its XML read in one pass, with the places where a writer may insert.

Nothing outside the text is looked at: document types, and with them entities of any kind, are refused.

Tested in `tests/quadpatch/formats/threemf/test_element_lists.py`.
"""

from dataclasses import dataclass, field
from typing import NamedTuple, NoReturn
from xml.parsers import expat

import numpy as np

from quadpatch.errors import FormatError, IndexRangeError, ReadError
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.text import parse_numbers, to_integers
from quadpatch.formats.threemf.element_lists import Block, Material, find_blocks
from quadpatch.types import FloatArray, Triangles, Vertices

_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02 "
_MATERIAL = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02 "
_PATH = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06 path"


@dataclass(frozen=True)
class Placed:
    """A component or a build item: an object of some model part, and where it goes."""

    path: str | None
    object_id: str
    matrix: FloatArray


@dataclass
class ModelObject:
    """An object while it is read: its mesh as words or in bulk, components, and where its lists end in the text."""

    default_pid: str | None
    default_index: str | None
    coordinates: list[str] = field(default_factory=list)
    corners: list[str] = field(default_factory=list)
    properties: list[Material] = field(default_factory=list)
    bulk: dict[str, FloatArray] = field(default_factory=dict)
    components: list[Placed] = field(default_factory=list)
    vertices_end: int = -1
    triangles_end: int = -1
    vertices: Vertices = field(default_factory=lambda: np.zeros((0, 3)))
    triangles: Triangles = field(default_factory=lambda: np.zeros((0, 3), dtype=np.int64))


class ModelImage(NamedTuple):
    """A texture image: the path of its entry, and what stands beyond its border along u and v, in words of 3MF."""

    path: str
    tile_u: str
    tile_v: str


class TextureGroup(NamedTuple):
    """A group of texture coordinates: the id of its image, and pairs of words."""

    image_id: str
    coordinates: list[tuple[str, str]]


@dataclass
class Model:
    """A model part: unit, objects by id, build items, what property groups hold, and where its lists end."""

    text: bytes
    unit: str = "millimeter"
    objects: dict[str, ModelObject] = field(default_factory=dict)
    items: list[Placed] = field(default_factory=list)
    colours: dict[str, list[str]] = field(default_factory=dict)
    images: dict[str, ModelImage] = field(default_factory=dict)
    texture_groups: dict[str, TextureGroup] = field(default_factory=dict)
    resources_start: int = -1
    resources_end: int = -1
    build_end: int = -1


def parse_model(text: bytes, limits: ReadLimits) -> Model:
    """Parse a model part.

    Parameters
    ----------
    text : bytes
        XML in an encoding of one byte for each ASCII character.
    limits : ReadLimits

    Raises
    ------
    MeshError
        ReadError, FormatError, IndexRangeError or TooLargeError.
    """
    if b"\0" in text[:64]:
        raise FormatError("a 3MF model in UTF-16 is not read: save it as UTF-8")
    handler = _Handler(Model(text), limits)
    parser = expat.ParserCreate(namespace_separator=" ")
    parser.StartElementHandler = handler.start
    parser.EndElementHandler = handler.end
    parser.StartDoctypeDeclHandler = _refuse_doctype
    handler.parser = parser
    try:
        at = 0
        for block in find_blocks(text):
            parser.Parse(text[at : block.start], False)
            at = block.stop if handler.take(block) else block.start
        parser.Parse(text[at:], True)
    except (expat.ExpatError, LookupError, ValueError) as error:
        raise ReadError(f"the 3MF model is no XML: {error}") from error
    for number, entry in handler.model.objects.items():
        _finish(number, entry, limits)
    return handler.model


def _refuse_doctype(*_: object) -> NoReturn:
    raise ReadError("the 3MF model has a document type, which 3MF does not allow")


class _Handler:
    """Collects a model from the parser's events."""

    def __init__(self, model: Model, limits: ReadLimits) -> None:
        self.model = model
        self.parser: expat.XMLParserType | None = None
        self._limits = limits
        self._open = ""
        self._skipped = 0
        self._object: ModelObject | None = None
        self._group: list[str] | None = None
        self._texture_group: TextureGroup | None = None
        self._starts = {
            _CORE + "model": self._start_model,
            _CORE + "object": self._start_object,
            _CORE + "vertex": self._vertex,
            _CORE + "triangle": self._triangle,
            _CORE + "component": self._component,
            _CORE + "item": self._item,
            _CORE + "basematerials": self._start_group,
            _MATERIAL + "colorgroup": self._start_group,
            _CORE + "resources": self._start_resources,
            _MATERIAL + "texture2d": self._image,
            _MATERIAL + "texture2dgroup": self._start_texture_group,
            _MATERIAL + "tex2coord": self._coordinate,
            _CORE + "base": self._colour,
            _MATERIAL + "color": self._colour,
        }

    def start(self, name: str, attributes: dict[str, str]) -> None:
        """Handle the beginning of an element."""
        self._open = name
        found = self._starts.get(name)
        if found is not None:
            found(attributes)

    def take(self, block: Block) -> bool:
        """Take a list in bulk if its element was opened right here; otherwise the parser has to read it."""
        entry = self._object
        if entry is None or self._open != _CORE + block.name or block.name in entry.bulk:
            return False
        if entry.coordinates if block.name == "vertices" else entry.corners:
            return False
        entry.bulk[block.name] = block.table
        entry.properties += block.materials
        self._skipped += block.stop - block.start
        return True

    def end(self, name: str) -> None:
        """Handle the end of an element: remember where lists end."""
        self._open = ""
        at = self.parser.CurrentByteIndex + self._skipped if self.parser is not None else -1
        if self._object is not None and name == _CORE + "vertices":
            self._object.vertices_end = at
        elif self._object is not None and name == _CORE + "triangles":
            self._object.triangles_end = at
        elif name == _CORE + "object":
            self._object = None
        elif name == _CORE + "resources":
            self.model.resources_end = at
        elif name == _CORE + "build":
            self.model.build_end = at

    def _start_model(self, attributes: dict[str, str]) -> None:
        self.model.unit = attributes.get("unit", "millimeter")

    def _start_object(self, attributes: dict[str, str]) -> None:
        number = attributes.get("id", "")
        if number in self.model.objects:
            raise ReadError(f"two objects of the 3MF model have the id {number[:40]!r}")
        self._object = ModelObject(attributes.get("pid"), attributes.get("pindex"))
        self.model.objects[number] = self._object

    def _vertex(self, attributes: dict[str, str]) -> None:
        if self._object is not None:
            words = self._object.coordinates
            words += (attributes.get("x", "?"), attributes.get("y", "?"), attributes.get("z", "?"))
            if len(words) > 3 * self._limits.max_vertices:
                self._limits.check_vertices(len(words) // 3)

    def _triangle(self, attributes: dict[str, str]) -> None:
        if self._object is not None:
            get = attributes.get
            words = self._object.corners
            words += (get("v1", "?"), get("v2", "?"), get("v3", "?"))
            self._object.properties.append((get("pid"), get("p1"), get("p2"), get("p3")))
            if len(words) > 3 * self._limits.max_triangles:
                self._limits.check_triangles(len(words) // 3)

    def _component(self, attributes: dict[str, str]) -> None:
        if self._object is not None:
            self._object.components.append(_placed(attributes))

    def _item(self, attributes: dict[str, str]) -> None:
        self.model.items.append(_placed(attributes))

    def _start_group(self, attributes: dict[str, str]) -> None:
        self._group = self.model.colours.setdefault(attributes.get("id", ""), [])

    def _start_resources(self, _: dict[str, str]) -> None:
        if self.parser is not None:
            start = self.parser.CurrentByteIndex + self._skipped
            self.model.resources_start = self.model.text.index(b">", start) + 1

    def _image(self, attributes: dict[str, str]) -> None:
        get = attributes.get
        image = ModelImage(get("path", ""), get("tilestyleu", "wrap"), get("tilestylev", "wrap"))
        self.model.images[get("id", "")] = image

    def _start_texture_group(self, attributes: dict[str, str]) -> None:
        self._texture_group = TextureGroup(attributes.get("texid", ""), [])
        self.model.texture_groups.setdefault(attributes.get("id", ""), self._texture_group)

    def _coordinate(self, attributes: dict[str, str]) -> None:
        if self._texture_group is not None:
            self._texture_group.coordinates.append((attributes.get("u", ""), attributes.get("v", "")))

    def _colour(self, attributes: dict[str, str]) -> None:
        if self._group is not None:
            self._group.append(attributes.get("color") or attributes.get("displaycolor") or "")


def _placed(attributes: dict[str, str]) -> Placed:
    matrix = np.eye(4)
    if "transform" in attributes:
        numbers = parse_numbers(attributes["transform"].encode())
        if len(numbers) != 12:
            raise ReadError(f"a 3MF transform has {len(numbers)} numbers instead of 12")
        # 3MF multiplies row vectors from the left.
        matrix[:3] = numbers.reshape(4, 3).T
    return Placed(attributes.get(_PATH), attributes.get("objectid", ""), matrix)


def _finish(number: str, entry: ModelObject, limits: ReadLimits) -> None:
    coordinates = parse_numbers(" ".join(entry.coordinates).encode())
    numbers = parse_numbers(" ".join(entry.corners).encode())
    if len(coordinates) != len(entry.coordinates) or len(numbers) != len(entry.corners):
        raise ReadError(f"3MF object {number[:40]!r} has an empty number")
    nothing = np.zeros((0, 3))
    coordinates = np.append(entry.bulk.get("vertices", nothing).ravel(), coordinates)
    corners = to_integers(np.append(entry.bulk.get("triangles", nothing).ravel(), numbers), "3MF triangles")
    limits.check_vertices(len(coordinates) // 3)
    limits.check_triangles(len(corners) // 3)
    entry.vertices = coordinates.reshape(-1, 3)
    entry.triangles = corners.reshape(-1, 3)
    if corners.size and (corners.min() < 0 or corners.max() >= len(entry.vertices)):
        wrong = int(corners.min()) if corners.min() < 0 else int(corners.max())
        raise IndexRangeError(
            f"a triangle of 3MF object {number[:40]!r} names vertex {wrong}; it has {len(entry.vertices):,} vertices"
        )
    entry.coordinates.clear()
    entry.corners.clear()
    entry.bulk.clear()
