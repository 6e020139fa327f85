"""One request for stations: a mesh and what to do with it."""

from typing import Any

from fastapi import APIRouter, Request
from pydantic import ValidationError
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from quadpatch_client.schema import JobSpec, RepairSpec
from quadpatch_rules.strict_json import StrictJsonError, read_json
from service.formats import clean_filename
from service.problems import invalid_request
from service.routes.common import FILE, problems
from service.routes.jobs import ACCEPTED, AskedDep, answer_submission
from service.routes.meshes import MESH_PREFIX, register_mesh
from service.services import ServicesDep
from service.strict_validation import StrictRoute
from service.uploads import UploadRules, receive_upload

router = APIRouter(tags=["jobs"], route_class=StrictRoute)

_BODY: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "content": {
            "multipart/form-data": {
                "schema": {
                    "type": "object",
                    "properties": {
                        "mesh": {**FILE, "description": "The mesh."},
                        "spec": {"$ref": "#/components/schemas/RepairSpec"},
                    },
                    "required": ["mesh"],
                    "additionalProperties": False,
                },
                "encoding": {"spec": {"contentType": "application/json"}},
            }
        },
    }
}


@router.post(
    "/v1/repairs",
    status_code=202,
    response_model=None,
    responses={
        **ACCEPTED,
        200: {**ACCEPTED[202], "description": "The job has ended already."},
        **problems(400, 404, 409, 413, 415, 507),
    },
    openapi_extra=_BODY,
)
async def repair(
    request: Request,
    services: ServicesDep,
    asked: AskedDep,
) -> Response:
    """Upload a mesh in the part `mesh`, say what to do with it in the part `spec` (JSON), get a job."""
    most = services.settings.max_upload_mb << 20
    rules = UploadRules("mesh", frozenset({"spec"}), MESH_PREFIX, most, allows_raw=False)
    upload = await receive_upload(request, services, rules)
    spec = _read_spec(upload.fields.get("spec", b"{}"))
    mesh, _ = await run_in_threadpool(register_mesh, services, upload, None, None)
    name = clean_filename(upload.filename)
    whole = JobSpec(
        mesh_id=mesh.id, mesh_name=name, **{field: getattr(spec, field) for field in RepairSpec.model_fields}
    )
    return await answer_submission(services, asked.submission(whole), asked.prefer)


def _read_spec(text: bytes) -> RepairSpec:
    try:
        read_json(text)
        return RepairSpec.model_validate_json(text)
    except StrictJsonError as error:
        raise invalid_request([{"loc": ("body", "spec"), "msg": str(error), "type": "json_invalid"}]) from error
    except ValidationError as error:
        details = error.errors(include_input=False, include_url=False)
        raise invalid_request([{**detail, "loc": ("body", "spec", *detail["loc"])} for detail in details]) from error
