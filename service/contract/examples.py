"""Examples of whole bodies, put together from the examples of their fields.

Tested in `tests/service/contract/test_examples.py`.
"""

from collections.abc import Mapping
from typing import Any

Schema = Mapping[str, Any]
REFERENCE = "#/components/schemas/"
_MISSING = object()
_BY_TYPE: Mapping[str, Any] = {"string": "text", "integer": 1, "number": 1.0, "boolean": True, "null": None}


def example_of(schema: Schema, schemas: Mapping[str, Schema]) -> Any:
    """Return a value that fits a schema.

    An object gets its required fields, and every other one that has an example of its own; a list gets one item.

    Parameters
    ----------
    schema : mapping
        JSON schema, as OpenAPI 3.1 has it.
    schemas : mapping
        What its references name.
    """
    for value in (_stated(schema), _chosen(schema, schemas)):
        if value is not _MISSING:
            return value
    if "properties" in schema:
        return _object(schema, schemas)
    kind = schema.get("type")
    if kind == "array":
        return [example_of(schema["items"], schemas)] if "items" in schema else []
    return {} if kind == "object" else _BY_TYPE.get(str(kind))


def _stated(schema: Schema) -> Any:
    """Return the value that the schema itself states."""
    if "const" in schema:
        return schema["const"]
    return schema["examples"][0] if schema.get("examples") else _MISSING


def _chosen(schema: Schema, schemas: Mapping[str, Schema]) -> Any:
    """Return the example of what a reference names, or of the first alternative; a default where there is one."""
    if "$ref" in schema:
        return example_of(schemas[schema["$ref"].removeprefix(REFERENCE)], schemas)
    if "default" in schema:
        return schema["default"]
    if "enum" in schema:
        return schema["enum"][0]
    alternatives = schema.get("anyOf") or schema.get("oneOf") or schema.get("allOf")
    return example_of(alternatives[0], schemas) if alternatives else _MISSING


def _object(schema: Schema, schemas: Mapping[str, Schema]) -> dict[str, Any]:
    required = schema.get("required", [])
    return {
        name: example_of(field, schemas)
        for name, field in schema["properties"].items()
        if name in required or _stated(field) is not _MISSING
    }
