"""Also tests `service/contract/messages.py` and `service/contract/tags.py`."""

import tomllib
from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any

import jsonschema_rs
import pytest
import yaml
from pydantic import SecretStr
from starlette.testclient import TestClient

from jobkit.settings import Settings
from quadpatch_client.schema.webhooks import MESSAGE_TYPES
from service.app import create_app
from service.contract.document import to_yaml
from service.contract.tags import TAGS

ROOT = Path(__file__).parents[3]


def followed(document: dict[str, Any], node: dict[str, Any]) -> dict[str, Any]:
    """Return what a reference of the document leads to, or the node itself."""
    if "$ref" not in node:
        return node
    found: Any = document
    for step in node["$ref"].removeprefix("#/").split("/"):
        found = found[step]
    return dict(found)


@pytest.fixture(scope="module")
def document() -> dict[str, Any]:
    built: dict[str, Any] = create_app(Settings.model_construct()).openapi()
    return built


def test_openapi_yaml_is_what_the_app_says(document: dict[str, Any]) -> None:
    """If this fails: `make openapi`, and look at the difference."""
    assert (ROOT / "openapi.yaml").read_text("utf-8") == to_yaml(document)


def test_the_service_hands_out_the_same_document(client: TestClient, document: dict[str, Any]) -> None:
    answer = client.get("/openapi.yaml")
    assert answer.headers["content-type"] == "application/yaml"
    assert yaml.safe_load(answer.text) == document == client.get("/openapi.json").json()


def test_a_service_with_keys_demands_them_in_its_document(document: dict[str, Any]) -> None:
    keyed = create_app(Settings.model_construct(api_keys=SecretStr("a-key-of-station-1"))).openapi()
    assert {} in document["security"]
    assert {} not in keyed["security"]


def test_every_error_is_documented_as_a_problem(document: dict[str, Any]) -> None:
    for path, operations in document["paths"].items():
        for method, operation in operations.items():
            errors = {status: answer for status, answer in operation["responses"].items() if status >= "400"}
            assert {"422", "500", "503"} <= errors.keys(), (method, path)
            for answer in errors.values():
                assert list(followed(document, answer)["content"]) == ["application/problem+json"], (method, path)


def test_every_parameter_and_field_says_what_it_is(document: dict[str, Any]) -> None:
    for path, operations in document["paths"].items():
        for operation in operations.values():
            for parameter in operation.get("parameters", []):
                assert parameter.get("description"), (path, parameter["name"])
    for name, schema in document["components"]["schemas"].items():
        for field, value in schema.get("properties", {}).items():
            assert value.get("description") or "$ref" in value, (name, field)


def test_every_route_of_the_design_is_there(document: dict[str, Any]) -> None:
    found = {f"{method.upper()} {path}" for path, operations in document["paths"].items() for method in operations}
    assert found >= {
        "POST /v1/meshes",
        "GET /v1/meshes/{mesh_id}",
        "GET /v1/meshes/{mesh_id}/content",
        "POST /v1/jobs",
        "POST /v1/repairs",
        "GET /v1/jobs",
        "GET /v1/jobs/{job_id}",
        "GET /v1/jobs/{job_id}/events",
        "GET /v1/jobs/{job_id}/result",
        "GET /v1/jobs/{job_id}/report",
        "GET /v1/jobs/{job_id}/preview.png",
        "POST /v1/jobs/{job_id}/cancel",
        "POST /v1/jobs/{job_id}/rerun",
        "GET /v1/models",
        "GET /v1/models/{name}",
        "GET /v1/models/{name}/versions/{version}",
        "GET /v1/models/{name}/versions/{version}/artifact",
        "POST /v1/models/{name}/versions",
        "DELETE /v1/models/{name}/versions/{version}",
        "PUT /v1/models/{name}/versions/{version}/deprecation",
        "DELETE /v1/models/{name}/versions/{version}/deprecation",
        "PUT /v1/aliases/{alias}",
        "DELETE /v1/aliases/{alias}",
        "GET /healthz",
        "GET /readyz",
    }


def operations(document: dict[str, Any], part: str = "paths") -> Iterator[dict[str, Any]]:
    for item in document[part].values():
        yield from item.values()


def test_every_operation_has_a_summary_in_words_and_a_tag_that_is_explained(document: dict[str, Any]) -> None:
    tags = {tag["name"] for tag in document["tags"]}
    summaries = [operation["summary"] for part in ("paths", "webhooks") for operation in operations(document, part)]
    assert all(5 < len(text) <= 120 and text[0].isupper() and "_" not in text for text in summaries), summaries
    used = {tag for operation in operations(document) for tag in operation["tags"]}
    assert used == tags == set(TAGS)


def test_the_document_has_the_version_of_the_package(document: dict[str, Any]) -> None:
    assert document["openapi"].startswith("3.1.")
    assert document["info"]["version"] == version("quadpatch")


def test_every_answer_says_that_it_has_a_request_id(document: dict[str, Any]) -> None:
    for operation in operations(document):
        for answer in operation["responses"].values():
            assert "X-Request-Id" in followed(document, answer)["headers"], operation["operationId"]


def test_every_json_body_has_an_example_that_fits_its_schema(document: dict[str, Any]) -> None:
    registry = {"$schema": "https://json-schema.org/draft/2020-12/schema", "components": document["components"]}
    n_examples = 0
    for part in ("paths", "webhooks"):
        for operation in operations(document, part):
            bodies = [operation.get("requestBody", {}), *operation["responses"].values()]
            for media_type, content in [item for body in bodies for item in body.get("content", {}).items()]:
                if "json" not in media_type or content["schema"].get("format") == "binary":
                    continue
                validator = jsonschema_rs.Draft202012Validator({**registry, **content["schema"]})
                validator.validate(content["example"])
                n_examples += 1
    assert n_examples > 50


def test_the_codes_of_problems_are_listed_and_others_may_come(document: dict[str, Any]) -> None:
    known, others = document["components"]["schemas"]["Problem"]["properties"]["code"]["anyOf"]
    assert {"mesh_not_found", "unauthorized", "idempotency_conflict"} <= set(known["enum"])
    assert others == {"type": "string"}


def test_every_message_to_subscribers_is_described_with_its_signature(document: dict[str, Any]) -> None:
    assert set(document["webhooks"]) == set(MESSAGE_TYPES)
    for operation in operations(document, "webhooks"):
        names = {parameter["name"] for parameter in operation["parameters"]}
        assert {"webhook-id", "webhook-timestamp", "webhook-signature"} == names
        assert operation["security"] == []
        assert "422" not in operation["responses"]


def test_every_answer_under_if_match_may_be_412_for_schemathesis(document: dict[str, Any]) -> None:
    operations = tomllib.loads((ROOT / "schemathesis.toml").read_text())["operations"]
    (listed,) = (
        rule["include-name"]
        for rule in operations
        if "416" in rule["checks"].get("positive_data_acceptance", {}).get("expected-statuses", [])
    )
    conditional = {
        f"{method.upper()} {path}"
        for path, methods in document["paths"].items()
        for method, operation in methods.items()
        if any(parameter["name"] == "If-Match" for parameter in operation.get("parameters", []))
    }
    assert set(listed) == conditional
