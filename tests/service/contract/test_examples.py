from typing import Any

import pytest

from service.contract.examples import example_of

SCHEMAS: dict[str, Any] = {"Box": {"type": "object", "properties": {"min": {"type": "number", "examples": [-1.5]}}}}


@pytest.mark.parametrize(
    ("schema", "example"),
    [
        ({"const": "fill"}, "fill"),
        ({"type": "string", "examples": ["a.ply"]}, "a.ply"),
        ({"type": "integer", "default": 7}, 7),
        ({"type": "string", "enum": ["ply", "stl"]}, "ply"),
        ({"anyOf": [{"type": "boolean"}, {"type": "null"}]}, True),
        ({"type": "array", "items": {"type": "null"}}, [None]),
        ({"type": "object"}, {}),
        ({"$ref": "#/components/schemas/Box"}, {"min": -1.5}),
    ],
)
def test_a_schema_has_an_example(schema: dict[str, Any], example: object) -> None:
    assert example_of(schema, SCHEMAS) == example


def test_an_object_has_what_it_needs_and_what_has_an_example() -> None:
    fields = {"needed": {"type": "string"}, "shown": {"type": "integer", "examples": [3]}, "left": {"type": "string"}}
    schema = {"type": "object", "required": ["needed"], "properties": fields}
    assert example_of(schema, SCHEMAS) == {"needed": "text", "shown": 3}
