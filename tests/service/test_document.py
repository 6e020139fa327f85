from pathlib import Path
from typing import Any

import pytest
import yaml
from pydantic import SecretStr
from starlette.testclient import TestClient

from jobkit.settings import Settings
from service.app import create_app
from service.document import to_yaml

ROOT = Path(__file__).parents[2]


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
                assert list(answer["content"]) == ["application/problem+json"], (method, path)


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
