"""3MF packages read as one mesh.

Also tests `quadpatch.formats.threemf.package`.
"""

import io
import zipfile

import numpy as np
import pytest

from quadpatch.errors import (
    CoordinateRangeError,
    EmptyMeshError,
    FormatError,
    IndexRangeError,
    NotFiniteError,
    ReadError,
    TooLargeError,
)
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.scan import Scan
from quadpatch.formats.threemf.reader import read_threemf
from tests.quadpatch.formats.threemf.packages import HEAD, mesh_text, model, package

BOX = Scan(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), np.array([[0, 2, 1], [0, 1, 3]]), "memory")
OBJECT = f'<object id="1">{mesh_text(BOX)}</object>'
ITEM = '<item objectid="1"/>'


def read(data: bytes) -> Scan:
    return read_threemf(data, ReadLimits())


def test_items_are_placed_and_the_unit_is_the_models() -> None:
    items = ITEM + '<item objectid="1" transform="0 1 0 -1 0 0 0 0 1 10 20 30"/>'
    scan = read(package(model(OBJECT, items)))
    assert scan.unit == "inch"
    assert scan.vertices[:4].tobytes() == BOX.vertices.tobytes()
    assert scan.vertices[4:].tolist() == [[10, 20, 30], [10, 21, 30], [9, 20, 30], [10, 20, 31]]


def test_components_are_followed_into_other_parts_of_the_package() -> None:
    parts = '<object id="2"><components><component objectid="1" p:path="/3D/part.model" '
    parts += 'transform="1 0 0 0 1 0 0 0 1 5 0 0"/><component objectid="1"/></components></object>'
    scan = read(package(model(OBJECT + parts, '<item objectid="2"/>'), part=model(OBJECT, "")))
    assert scan.vertices[[0, 4]].tolist() == [[5, 0, 0], [0, 0, 0]]


def test_an_item_that_mirrors_turns_its_triangles() -> None:
    scan = read(package(model(OBJECT, '<item objectid="1" transform="-1 0 0 0 1 0 0 0 1 0 0 0"/>')))
    assert scan.triangles.tolist() == BOX.triangles[:, [0, 2, 1]].tolist()


def test_colours_of_groups_and_base_materials_are_read() -> None:
    group = '<m:colorgroup id="5"><m:color color="#FF000080"/><m:color color="#00FF00"/></m:colorgroup>'
    coloured = f'<object id="1" pid="5" pindex="1">{mesh_text(BOX)}</object>'
    scan = read(package(model(group + coloured.replace('v3="1"', 'v3="1" pid="5" p1="0"'), ITEM)))
    assert scan.source is not None
    colours = scan.source.vertex_attributes(scan).colours
    assert colours is not None
    assert colours.tolist() == [[255, 0, 0, 128]] * 3 + [[0, 255, 0, 255]]


@pytest.mark.parametrize(
    ("text", "error"),
    [
        (model(OBJECT, ""), EmptyMeshError),
        (model('<object id="1"/>', ITEM), EmptyMeshError),
        (model(OBJECT, '<item objectid="9"/>'), ReadError),
        (model(OBJECT + OBJECT, ITEM), ReadError),
        (model('<object id="1"><components><component objectid="1"/></components></object>', ITEM), ReadError),
        (model(OBJECT.replace('v3="1"', 'v3="7"'), ITEM), IndexRangeError),
        (model(OBJECT.replace('v3="1"', 'v3="-1"'), ITEM), IndexRangeError),
        (model(OBJECT.replace('v3="1"', ""), ITEM), ReadError),
        (model(OBJECT.replace('v3="1"', 'v3=""'), ITEM), ReadError),
        (model(OBJECT.replace('v3="1"', 'v3="1 2"'), ITEM), ReadError),
        (model(OBJECT.replace('x="1.0"', 'x="inf"'), ITEM), NotFiniteError),
        (model(OBJECT, '<item objectid="1" transform="1 2 3"/>'), ReadError),
        (model(OBJECT, '<item objectid="1" transform="1e200 0 0 0 1 0 0 0 1 0 0 0"/>'), CoordinateRangeError),
        (model(OBJECT, ITEM)[:-20], ReadError),
        (HEAD.replace("<model", '<!DOCTYPE a [<!ENTITY b "c">]><model') + "</model>", ReadError),
    ],
)
def test_wrong_models_are_refused(text: str, error: type[Exception]) -> None:
    with pytest.raises(error):
        read(package(text))


def test_utf_16_is_refused_by_name() -> None:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as target:
        target.writestr("3D/3dmodel.model", model(OBJECT, ITEM).replace("UTF-8", "UTF-16").encode("utf-16"))
    with pytest.raises(FormatError, match="UTF-16"):
        read(packed.getvalue())


def test_components_that_double_at_every_level_are_stopped() -> None:
    twice = '<component objectid="{0}"/><component objectid="{0}"/>'
    levels = "".join(f'<object id="{n}"><components>{twice.format(n - 1)}</components></object>' for n in range(2, 60))
    empty = '<object id="1"><mesh><vertices/><triangles/></mesh></object>'
    with pytest.raises(TooLargeError):
        read(package(model(empty + levels, '<item objectid="59"/>')))


def test_a_package_that_unpacks_to_more_than_the_limit_is_not_unpacked() -> None:
    bomb = package(model(OBJECT, ITEM) + " " * 50_000_000)
    assert len(bomb) < 100_000
    with pytest.raises(TooLargeError):
        read_threemf(bomb, ReadLimits(max_bytes=1_000_000))


def test_a_broken_entry_is_named_before_the_work_begins() -> None:
    data = bytearray(package(model(OBJECT, ITEM)))
    at = data.index(b"\x89PNG") if b"\x89PNG" in data else data.index(b"thumbnail.png") + 16
    data[at] ^= 0xFF
    with pytest.raises(ReadError):
        read(bytes(data))
