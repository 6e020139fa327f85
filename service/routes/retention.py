"""Delete jobs and meshes, and pin those that retention must keep."""

from http import HTTPStatus

from fastapi import APIRouter
from starlette.responses import Response

from jobkit.retention import delete_job as delete_job_row
from jobkit.retention import delete_mesh as delete_mesh_row
from jobkit.retention import pin_job as set_job_pin
from jobkit.retention import pin_mesh as set_mesh_pin
from service.routes.common import JobIdPath, MeshIdPath, problems
from service.services import ServicesDep
from service.strict_validation import StrictRoute

router = APIRouter(tags=["retention"], route_class=StrictRoute)


@router.delete("/v1/jobs/{job_id}", status_code=204, response_class=Response, responses=problems(404, 409))
def delete_job(services: ServicesDep, job_id: JobIdPath) -> Response:
    """Delete a finished job with its result, its events and its idempotency keys. There is no way back."""
    delete_job_row(services.database, services.store, job_id)
    return _done()


@router.delete("/v1/meshes/{mesh_id}", status_code=204, response_class=Response, responses=problems(404, 409))
def delete_mesh(services: ServicesDep, mesh_id: MeshIdPath) -> Response:
    """Delete a mesh that no job names. There is no way back but to upload it again."""
    delete_mesh_row(services.database, mesh_id)
    return _done()


@router.put("/v1/jobs/{job_id}/pin", status_code=204, response_class=Response, responses=problems(404))
def pin_job(services: ServicesDep, job_id: JobIdPath) -> Response:
    """Keep a job, and its mesh, whatever the retention."""
    set_job_pin(services.database, job_id, True)
    return _done()


@router.delete("/v1/jobs/{job_id}/pin", status_code=204, response_class=Response, responses=problems(404))
def unpin_job(services: ServicesDep, job_id: JobIdPath) -> Response:
    """Leave a job to the retention again; where that is past, it goes with the next sweep."""
    set_job_pin(services.database, job_id, False)
    return _done()


@router.put("/v1/meshes/{mesh_id}/pin", status_code=204, response_class=Response, responses=problems(404))
def pin_mesh(services: ServicesDep, mesh_id: MeshIdPath) -> Response:
    """Keep a mesh whatever the retention."""
    set_mesh_pin(services.database, mesh_id, True)
    return _done()


@router.delete("/v1/meshes/{mesh_id}/pin", status_code=204, response_class=Response, responses=problems(404))
def unpin_mesh(services: ServicesDep, mesh_id: MeshIdPath) -> Response:
    """Leave a mesh to the retention again; where that is past, it goes with the next sweep."""
    set_mesh_pin(services.database, mesh_id, False)
    return _done()


def _done() -> Response:
    return Response(status_code=HTTPStatus.NO_CONTENT)
