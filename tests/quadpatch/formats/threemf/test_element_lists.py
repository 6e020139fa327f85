"""Lists taken in bulk give what the XML parser gives."""

from collections.abc import Callable

import numpy as np
import pytest

from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.scan import Scan
from quadpatch.formats.threemf.element_lists import find_blocks
from quadpatch.formats.threemf.model import parse_model
from tests.quadpatch.formats.fills import as_scan
from tests.quadpatch.formats.threemf.packages import mesh_text, model
from tests.quadpatch.shapes import sphere

BALL = as_scan(sphere(1))
OBJECT = f'<object id="1">{mesh_text(BALL)}</object>'


def is_read(text: str) -> bool:
    parsed = parse_model(model(text, "").encode(), ReadLimits()).objects["1"]
    same = parsed.vertices.tobytes() == BALL.vertices.tobytes()
    return same and parsed.triangles.tolist() == BALL.triangles.tolist()


def test_both_lists_of_a_usual_object_are_found() -> None:
    blocks = list(find_blocks(OBJECT.encode()))
    assert [block.name for block in blocks] == ["vertices", "triangles"]
    assert blocks[0].table.tobytes() == BALL.vertices.tobytes()
    assert is_read(OBJECT)


UNUSUAL: list[Callable[[str], str]] = [
    lambda text: text.replace('"', "'"),
    lambda text: text.replace("<vertex x", "<vertex  id='3' x"),
    lambda text: text.replace("/><triangle", "></triangle><triangle", 1),
    lambda text: text.replace("/><vertex", "/><!-- a comment --><vertex", 3),
    lambda text: text.replace("<triangles>", "<triangles id='a'>"),
    lambda text: text.replace('x="', 'x=" '),
    lambda text: text.replace("<mesh>", "<!-- <vertices><vertex x='1' y='1' z='1'/></vertices> --><mesh>"),
    lambda text: text.replace("<mesh>", '<!-- <vertices><vertex x="1" y="1" z="1"/></vertices> --><mesh>'),
    lambda text: text.replace("<mesh>", '<metadata><vertices><vertex x="1" y="1" z="1"/></vertices></metadata><mesh>')
    .replace("<metadata>", '<metadata xmlns="urn:other">'),
]  # fmt: skip


@pytest.mark.parametrize("change", UNUSUAL)
def test_lists_of_another_form_are_left_to_the_parser(change: Callable[[str], str]) -> None:
    assert change(OBJECT) != OBJECT
    assert is_read(change(OBJECT))


def test_places_to_insert_are_the_same_with_and_without_bulk() -> None:
    text = model(OBJECT + OBJECT.replace('id="1"', 'id="2"'), '<item objectid="1"/>')
    for version in (text, text.replace('"', "'")):
        parsed = parse_model(version.encode(), ReadLimits())
        for entry in parsed.objects.values():
            assert version.encode()[entry.vertices_end :].startswith(b"</vertices>")
            assert version.encode()[entry.triangles_end :].startswith(b"</triangles>")
        assert version.encode()[parsed.build_end :] == b"</build></model>"


def test_materials_are_read_in_any_order() -> None:
    scan = Scan(np.eye(3), np.array([[0, 1, 2]]), "memory")
    material = ' p1="4" pid="7"'
    text = f'<object id="1">{mesh_text(scan, material=material)}</object>'
    (_, block) = find_blocks(text.encode())
    assert block.materials == [("7", "4", None, None)]
    parsed = parse_model(model(text, "").encode(), ReadLimits())
    assert parsed.objects["1"].properties == [("7", "4", None, None)]
