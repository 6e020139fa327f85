"""Rules: save, list, look at, try on a mesh, delete."""

from http import HTTPStatus
from typing import Annotated, Any

from fastapi import APIRouter, Path, Query
from starlette.responses import Response

from jobkit.errors import OptionsConflictError
from jobkit.rules import Rules
from quadpatch_client.schema import JobSpec, RepairSpec, Rule, RuleContent, RulePage, RulePlan, RuleTrial, conflict_of
from quadpatch_client.schema.base import NAME_PATTERN, REFERENCE_PATTERN
from service.finding import Limit
from service.routes.common import VersionPath, described_header, json_response, problems
from service.services import ServicesDep
from service.strict_validation import StrictRoute
from service.submission import plan

router = APIRouter(tags=["rules"], route_class=StrictRoute)

RuleNamePath = Annotated[str, Path(pattern=NAME_PATTERN, description="Name of a rule.", examples=["castings"])]
RuleReferencePath = Annotated[
    str, Path(pattern=REFERENCE_PATTERN, description="`name`, or `name@version`.", examples=["castings@2"])
]
NameCursor = Annotated[
    str | None, Query(pattern=NAME_PATTERN, description="`next_cursor` of the page before this one.")
]
VersionCursor = Annotated[
    int | None, Query(ge=1, le=2**31 - 1, description="`next_cursor` of the page before this one.")
]
_SAVED: dict[str, Any] = {
    "headers": {"Location": described_header("Path of the version.")},
    "links": {
        "get_rule_version": {
            "operationId": "get_rule_version",
            "parameters": {"name": "$response.body#/name", "version": "$response.body#/version"},
        }
    },
}
_EXAMPLES: dict[str, Any] = {
    "requestBody": {
        "content": {
            "application/json": {
                "examples": {
                    "castings": {
                        "summary": "Small holes, filled with care, and held to an expected error",
                        "value": {
                            "holes": {"rules": [{"min_diameter": 25.0, "action": "skip"}]},
                            "method": {"method": "auto", "effort": "best"},
                            "acceptance": {"max_expected_error": 0.1, "otherwise": "fail"},
                        },
                    }
                }
            }
        }
    }
}


@router.put(
    "/v1/rules/{name}",
    status_code=201,
    response_model=Rule,
    responses={
        201: {"description": "The version is new.", **_SAVED},
        200: {"model": Rule, "description": "The latest version says the same.", **_SAVED},
        **problems(400, 413, 415),
    },
    openapi_extra=_EXAMPLES,
)
def save_rule(services: ServicesDep, name: RuleNamePath, content: RuleContent) -> Response:
    """Save a rule: a new one, or the next version. Versions never change; jobs are pinned to one."""
    said = content.model_dump(include={"holes", "method", "colours"})
    conflict = conflict_of(RepairSpec.model_validate(said))
    if conflict is not None:
        raise OptionsConflictError(conflict)
    rule, is_new = Rules(services.database).save(name, content)
    return json_response(rule, HTTPStatus.CREATED if is_new else HTTPStatus.OK, Location=rule.links.self)


@router.get("/v1/rules", response_model=RulePage, responses=problems())
def list_rules(services: ServicesDep, limit: Limit = 20, cursor: NameCursor = None) -> RulePage:
    """List rules by name, each in its latest version."""
    return Rules(services.database).page(limit, cursor)


@router.get("/v1/rules/{name}", response_model=Rule, responses=problems(404))
def get_rule(services: ServicesDep, name: RuleNamePath) -> Rule:
    """Show the latest version of a rule."""
    return Rules(services.database).get(name)


@router.get("/v1/rules/{name}/versions", response_model=RulePage, responses=problems(404))
def list_rule_versions(
    services: ServicesDep, name: RuleNamePath, limit: Limit = 20, cursor: VersionCursor = None
) -> RulePage:
    """List the versions of a rule, newest first."""
    return Rules(services.database).versions(name, limit, cursor)


@router.get("/v1/rules/{name}/versions/{version}", response_model=Rule, responses=problems(404))
def get_rule_version(services: ServicesDep, name: RuleNamePath, version: VersionPath) -> Rule:
    """Show one version of a rule."""
    return Rules(services.database).get(name, version)


@router.delete("/v1/rules/{name}", status_code=204, response_class=Response, responses=problems(404))
def delete_rule(services: ServicesDep, name: RuleNamePath) -> Response:
    """Delete a rule with all its versions. Jobs that named it keep what it said; its numbers never come back."""
    Rules(services.database).delete(name)
    return Response(status_code=HTTPStatus.NO_CONTENT)


@router.post(
    "/v1/rules/{reference}/dry-run",
    response_model=RulePlan,
    responses=problems(400, 404, 409, 413, 415),
)
def dry_run_rule(services: ServicesDep, reference: RuleReferencePath, trial: RuleTrial) -> RulePlan:
    """Say what the rule would do with each loop of a mesh, from its analysis, without a job."""
    rule = Rules(services.database).resolve(reference)
    pinned = f"{rule.name}@{rule.version}"
    planned = plan(services, JobSpec(mesh_id=trial.mesh_id, rule=pinned))
    return RulePlan(rule=pinned, plan=planned, acceptance=rule.content.acceptance)
