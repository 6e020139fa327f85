"""Views: surfaces in two levels, outlines of holes, pictures of models; made when they are first asked for."""

from typing import Annotated, Any

from fastapi import APIRouter, Query, Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from jobkit.errors import ViewFailedError
from jobkit.views import ViewOrder
from quadpatch_client.schema.base import EXAMPLE_SHA256
from quadpatch_client.schema.views import Outlines, ViewLevel, ViewState
from quadpatch_rules.ids import SHA256_PATTERN
from quadpatch_rules.tasks import TRAIN
from service.mesh_checks import check_reference
from service.routes.common import (
    BINARY,
    CONDITIONAL,
    JobIdPath,
    MeshIdPath,
    ModelNamePath,
    VersionPath,
    described_header,
    not_modified,
    problems,
)
from service.routes.results import require_result
from service.services import Services, ServicesDep
from service.strict_validation import StrictRoute
from service.views import WantedView, view_response
from service.waiting import PreferHeader

router = APIRouter(tags=["views"], route_class=StrictRoute)

GLB = "model/gltf-binary"
Level = Annotated[
    ViewLevel, Query(description="`coarse`: less than 2 MB, there first; `fine`: up to 20 MB.", examples=["coarse"])
]
Reference = Annotated[
    str | None,
    Query(
        pattern=SHA256_PATTERN,
        description="Id of a mesh in the same place and unit; each vertex gets its distance to it.",
        examples=[EXAMPLE_SHA256],
    ),
]


def _documented(media_type: str, **whole: Any) -> dict[int | str, dict[str, Any]]:
    content = {media_type: {"schema": BINARY}}
    return {
        200: {"description": "The whole file.", **(whole or {"content": content})},
        202: {
            "model": ViewState,
            "description": "A worker is yet to make it: ask again, or send `Prefer: wait=N`.",
            "headers": {"Retry-After": described_header("Seconds to the next try.")},
        },
        206: {"description": "The range.", "content": content},
        **not_modified(),
        **problems(404, 409, 410, 412, 416, 507),
    }


@router.get(
    "/v1/meshes/{mesh_id}/view",
    response_class=Response,
    dependencies=CONDITIONAL,
    responses=_documented(GLB),
)
async def get_mesh_view(
    request: Request,
    services: ServicesDep,
    mesh_id: MeshIdPath,
    level: Level = "coarse",
    prefer: PreferHeader = None,
) -> Response:
    """Fetch a mesh for a viewer: reduced, as GLB, with its vertex colours. It need not be analysed yet."""
    await run_in_threadpool(_check_mesh, services, mesh_id, "mesh")
    order = ViewOrder("mesh", mesh_id=mesh_id, level=level)
    return await view_response(request, services, WantedView(order, GLB, f"mesh-{mesh_id[:12]}-{level}.glb"), prefer)


@router.get(
    "/v1/meshes/{mesh_id}/outlines",
    response_class=Response,
    dependencies=CONDITIONAL,
    responses=_documented("application/json", model=Outlines),
)
async def get_mesh_outlines(
    request: Request, services: ServicesDep, mesh_id: MeshIdPath, prefer: PreferHeader = None
) -> Response:
    """Fetch the rims of a mesh's holes as closed polylines, by the ids that its analysis gives them."""
    await run_in_threadpool(_check_mesh, services, mesh_id, "mesh")
    order = ViewOrder("outlines", mesh_id=mesh_id)
    wanted = WantedView(order, "application/json", f"mesh-{mesh_id[:12]}-outlines.json")
    return await view_response(request, services, wanted, prefer)


@router.get(
    "/v1/jobs/{job_id}/view",
    response_class=Response,
    dependencies=CONDITIONAL,
    responses=_documented(GLB),
)
async def get_job_view(
    request: Request,
    services: ServicesDep,
    job_id: JobIdPath,
    level: Level = "coarse",
    reference: Reference = None,
    prefer: PreferHeader = None,
) -> Response:
    """Fetch the result of a job for a viewer: what is invented apart from what was measured, with how sure it is."""
    order = await run_in_threadpool(_job_order, services, job_id, level, reference)
    return await view_response(request, services, WantedView(order, GLB, f"{job_id}-{level}.glb"), prefer)


@router.get(
    "/v1/models/{name}/versions/{version}/picture",
    response_class=Response,
    dependencies=CONDITIONAL,
    responses=_documented("image/png"),
)
async def get_model_picture(
    request: Request,
    services: ServicesDep,
    name: ModelNamePath,
    version: VersionPath,
    prefer: PreferHeader = None,
) -> Response:
    """Fetch a picture of a model: the atoms of a dictionary, or the first filters of a network, in a grid."""
    await run_in_threadpool(services.registry.usable, f"{name}@{version}")
    order = ViewOrder("model", model_name=name, model_version=version)
    return await view_response(request, services, WantedView(order, "image/png", f"{name}@{version}.png"), prefer)


def _check_mesh(services: Services, mesh_id: str, name: str) -> None:
    check_reference(services.meshes.get(mesh_id), name)


def _job_order(services: Services, job_id: str, level: ViewLevel, reference: str | None) -> ViewOrder:
    """Check what a view of a job is made of."""
    job = services.jobs.get(job_id)
    require_result(job)
    if job.result is None or job.spec.task == TRAIN or job.result.format == "qpz":
        raise ViewFailedError(f"job {job_id} made no mesh that could be shown")
    if reference is not None:
        _check_mesh(services, reference, "the reference")
    return ViewOrder("job", mesh_id=job.mesh_id, job_id=job_id, reference_id=reference, level=level)
