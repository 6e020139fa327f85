"""Letter H: no request body is taken with a field that its schema does not name, at whatever depth."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from starlette.testclient import TestClient

from quadpatch_rules.text import printable

DOCUMENT = yaml.safe_load((Path(__file__).resolve().parents[2] / "openapi.yaml").read_text("utf-8"))
# Objects whose names are the sender's own: labels of a job, and the card of a model, which is kept as it is.
OPEN = {"/metadata", "/spec/metadata", "/jobs/0/metadata", "/card"}
FORM, JSON = "multipart/form-data", "application/json"
MESH = b"ply\nformat ascii 1.0\nend_header\n"
Schema = dict[str, Any]


@dataclass(frozen=True)
class Place:
    """An object somewhere in the body of an operation: steps that lead to it, and its schema.

    A step is a name, a number for an item of an array, or a schema that stands for a choice between several.
    """

    method: str
    path: str
    media_type: str
    body: Schema
    steps: tuple[tuple[str, str], ...]
    schema: Schema

    @property
    def pointer(self) -> str:
        """The JSON pointer to the object."""
        return "".join(f"/{name}" for kind, name in self.steps if kind != "choice")

    def __str__(self) -> str:
        choices = "".join(f" {name}" for kind, name in self.steps if kind == "choice")
        return f"{self.method} {self.path} {self.pointer or '/'}{choices}"


def resolved(schema: Schema) -> Schema:
    while "$ref" in schema:
        schema = DOCUMENT["components"]["schemas"][schema["$ref"].rpartition("/")[2]]
    return schema


def choices(schema: Schema) -> list[Schema]:
    return [*schema.get("oneOf", []), *schema.get("anyOf", [])]


def objects(schema: Schema, steps: tuple[tuple[str, str], ...] = ()) -> Iterator[tuple[tuple[Any, ...], Schema]]:
    """Yield all objects in a schema with the steps that lead to them."""
    schema = resolved(schema)
    if schema.get("type") == "object":
        yield steps, schema
    for name, inner in schema.get("properties", {}).items():
        yield from objects(inner, (*steps, ("name", name)))
    for number, inner in enumerate(choices(schema)):
        yield from objects(inner, (*steps, ("choice", str(number))))
    if "items" in schema:
        yield from objects(schema["items"], (*steps, ("item", "0")))


def places() -> Iterator[Place]:
    for path, methods in DOCUMENT["paths"].items():
        for method, operation in methods.items():
            for media_type, content in operation.get("requestBody", {}).get("content", {}).items():
                for steps, schema in objects(content["schema"]):
                    yield Place(method, path, media_type, content["schema"], steps, schema)


ALL = list(places())
CLOSED = [place for place in ALL if place.pointer not in OPEN]
IN_JSON = [place for place in CLOSED if place.media_type == JSON or place.steps]
PARTS = [place for place in CLOSED if place.media_type == FORM and not place.steps]


def sample(schema: Schema, steps: tuple[tuple[str, str], ...] = ()) -> Any:
    """Make a value that fits a schema and leads along the steps."""
    schema = resolved(schema)
    if steps[:1] and steps[0][0] == "choice":
        return sample(choices(schema)[int(steps[0][1])], steps[1:])
    if steps[:1] and steps[0][0] == "item":
        return [sample(schema["items"], steps[1:])]
    if schema.get("type") == "object":
        # What has a default tells choices apart, so it is named as well.
        named = {*schema.get("required", []), *(n for n, s in schema.get("properties", {}).items() if "const" in s)}
        made = {name: sample(schema["properties"][name]) for name in sorted(named) if name in schema["properties"]}
        if steps:
            made[steps[0][1]] = sample(schema["properties"][steps[0][1]], steps[1:])
        return made
    return plain(schema)


def plain(schema: Schema) -> Any:
    for key in ("const", "default"):
        if key in schema:
            return schema[key]
    for key in ("enum", "examples"):
        if schema.get(key):
            return schema[key][0]
    if choices(schema):
        return sample(choices(schema)[0])
    return {"string": "x", "integer": 1, "number": 1.0, "boolean": True, "array": []}.get(schema.get("type", ""))


def at(body: Any, place: Place) -> dict[str, Any]:
    """Return the object that a place means."""
    for kind, name in place.steps:
        if kind != "choice":
            body = body[int(name)] if kind == "item" else body[name]
    found: dict[str, Any] = body
    return found


def address(place: Place) -> str:
    """The path with examples in the place of its parameters."""
    path = place.path
    for parameter in DOCUMENT["paths"][place.path][place.method]["parameters"]:
        if parameter["in"] == "path":
            value = (parameter.get("examples") or parameter["schema"]["examples"])[0]
            path = path.replace("{" + parameter["name"] + "}", str(value))
    return path


def send(client: TestClient, place: Place, body: Any) -> Any:
    """Send a body; of a form, its JSON parts beside a file."""
    if place.media_type == JSON:
        return client.request(place.method, address(place), content=json.dumps(body), headers={"Content-Type": JSON})
    file = next(name for name, part in place.body["properties"].items() if part.get("format") == "binary")
    fields = {name: json.dumps(value) for name, value in body.items() if name != file}
    return client.request(place.method, address(place), files={file: ("a.ply", MESH)}, data=fields)


def unknown_names(place: Place) -> st.SearchStrategy[str]:
    """Names that the schema lacks: anything, and what is nearly right."""
    known = sorted(place.schema.get("properties", {}))
    near = [f"{name}s" for name in known] + [name.upper() for name in known] + [f" {name}" for name in known]
    anything = st.text(st.characters(codec="utf-8"), max_size=40)
    return st.one_of(st.sampled_from([*near, "__proto__"]), anything).filter(lambda name: name not in known)


def test_every_object_in_a_body_is_closed_unless_its_names_are_the_senders() -> None:
    assert {place.pointer for place in ALL} >= OPEN
    for place in ALL:
        is_closed = place.schema.get("additionalProperties") is False
        assert is_closed == (place.pointer not in OPEN), str(place)
    # Bodies that are not JSON objects are files.
    assert {place.media_type for place in ALL} == {FORM, JSON}


@settings(max_examples=8, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(data=st.data())
def test_an_unknown_field_is_refused_by_its_name(client: TestClient, data: st.DataObject) -> None:
    for place in IN_JSON:
        body = sample(place.body, place.steps)
        name = data.draw(unknown_names(place), label=str(place))
        at(body, place)[name] = data.draw(st.sampled_from([None, True, -9, "x", {}, []]))
        answer = send(client, place, body)
        pointer = printable(f"{place.pointer}/" + name.replace("~", "~0").replace("/", "~1"))
        assert answer.status_code == 422, (str(place), answer.text)
        found = [(error["location"], error["pointer"], error["code"]) for error in answer.json()["errors"]]
        assert ("body", pointer, "extra_forbidden") in found, str(place)


@settings(max_examples=8, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(name=st.text("abcdefgh_-[]", min_size=1, max_size=20))
def test_an_unknown_part_of_a_form_is_refused_by_its_name(client: TestClient, name: str) -> None:
    for place in PARTS:
        answer = send(client, place, {name: "x"})
        assert answer.status_code == 422, (str(place), answer.text)
        found = [(error["pointer"], error["code"]) for error in answer.json()["errors"]]
        assert found == [(f"/{name}", "extra_forbidden")], str(place)
