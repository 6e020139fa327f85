"""Meshes: upload, facts and holes, the bytes again."""

from http import HTTPStatus
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Header, Query, Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from jobkit.database.idempotency import note_request, refuse_conflict
from jobkit.database.searching import CURSOR_PATTERN
from jobkit.database.tenancy import mesh_id_of
from jobkit.errors import MeshNotFoundError, ObjectNotFoundError
from jobkit.meshes import MESH_DAMAGED, MESH_MISSING
from jobkit.storage.base import StoredObject
from jobkit.storage.removals import assure
from quadpatch_client.schema import Format, Mesh, MeshPage, MeshState
from service.body_limit import has_body
from service.content import Content, content_response
from service.digests import announced_sha256
from service.finding import Limit, MeshSearchDep
from service.formats import clean_filename, stated_format
from service.idempotency import note_replayed
from service.problems import RETRY_AFTER_S
from service.routes.common import (
    BINARY,
    CONDITIONAL,
    FILE,
    CallerDep,
    MeshIdPath,
    described_header,
    json_response,
    linked,
    not_modified,
    problems,
)
from service.services import Services, ServicesDep
from service.strict_validation import StrictRoute
from service.submission import request_analysis
from service.uploads import Upload, UploadRules, receive_upload, upload_of
from service.waiting import PreferHeader, note_applied, preferred_wait_s

router = APIRouter(tags=["meshes"], route_class=StrictRoute)
MESH_PREFIX = "meshes"

_UPLOAD_BODY: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "description": "The file itself, or a form with the file in its part `file`. It may come in gzip or zstd "
        "(`Content-Encoding`).",
        "content": {
            "application/octet-stream": {"schema": FILE},
            "multipart/form-data": {
                "schema": {
                    "type": "object",
                    "properties": {"file": {**FILE, "description": "The mesh."}},
                    "required": ["file"],
                    "additionalProperties": False,
                }
            },
        },
    }
}
_LINKS = {
    "mesh": linked("get_mesh", "$response.body#/id", "mesh_id"),
    "content": linked("get_mesh_content", "$response.body#/id", "mesh_id"),
}
_UPLOADED = {
    "headers": {"Location": described_header("Path of the mesh.")},
    "links": _LINKS,
}
FilenameQuery = Annotated[
    str | None,
    Query(max_length=255, description="Name of the file; its suffix tells the format.", examples=["face000.ply"]),
]
FormatQuery = Annotated[Format | None, Query(description="Format of the file; null: from its name or media type.")]
MeshCursor = Annotated[
    str | None, Query(pattern=CURSOR_PATTERN, description="`next_cursor` of the page before this one.")
]
WaitQuery = Annotated[
    int, Query(ge=0, le=300, description="Let the answer wait up to so many seconds for the analysis.", examples=[10])
]


def _file_headers(
    disposition: Annotated[
        str | None, Header(alias="Content-Disposition", description="May name the file: `attachment; filename=…`.")
    ] = None,
    digest: Annotated[
        str | None,
        Header(
            alias="Repr-Digest",
            description="sha-256 of the file (RFC 9530): bytes that are there already need not be sent.",
        ),
    ] = None,
) -> None:
    """Document the headers that `service.uploads` and `service.digests` read."""


@router.post(
    "/v1/meshes",
    status_code=201,
    response_model=Mesh,
    responses={
        201: {"description": "The mesh is new; a worker will analyse it.", **_UPLOADED},
        200: {"model": Mesh, "description": "The same bytes were uploaded before.", **_UPLOADED},
        **problems(400, 404, 409, 413, 415, 507),
    },
    openapi_extra=_UPLOAD_BODY,
    dependencies=[Depends(_file_headers)],
)
async def upload_mesh(
    request: Request,
    services: ServicesDep,
    caller: CallerDep,
    filename: FilenameQuery = None,
    format: FormatQuery = None,  # noqa: A002 - the name of the query parameter
) -> Response:
    """Upload a mesh. The same bytes are the same mesh, however often they come.

    With the sha-256 of the file in `Repr-Digest`, of bytes that are there already, the body is not read, and may be
    empty. Where they are not there, a request without a body is answered with 404, `mesh_not_found`.
    """
    sha256 = announced_sha256(request.headers)
    known = None if sha256 is None else await run_in_threadpool(_known_bytes, services, sha256)
    if known is not None:
        upload = upload_of(request, known)
    elif sha256 is not None and not has_body(request.scope):
        raise MeshNotFoundError(f"there is no mesh {sha256} with its bytes; send them")
    else:
        rules = UploadRules("file", frozenset(), MESH_PREFIX, services.settings.max_upload_mb << 20)
        upload = await receive_upload(request, services, rules)
    request_parts = ("upload_mesh", upload.stored.sha256, filename or upload.filename or "", format or "")
    idempotency = caller.idempotency(*request_parts)
    await run_in_threadpool(refuse_conflict, services.database, idempotency)
    mesh, is_new = await run_in_threadpool(register_mesh, services, upload, filename, format)
    is_first = await run_in_threadpool(note_request, services.database, idempotency, mesh.links.self)
    response = json_response(mesh, HTTPStatus.CREATED if is_new else HTTPStatus.OK, Location=mesh.links.self)
    return note_replayed(response, is_new=is_first)


@router.get("/v1/meshes", response_model=MeshPage, responses=problems())
def list_meshes(services: ServicesDep, search: MeshSearchDep, limit: Limit = 20, cursor: MeshCursor = None) -> MeshPage:
    """List meshes, newest first. Those that arrive meanwhile don't shift the pages."""
    return services.meshes.page(limit, cursor, search)


@router.get("/v1/meshes/{mesh_id}", response_model=Mesh, responses=problems(404))
async def get_mesh(
    response: Response, services: ServicesDep, mesh_id: MeshIdPath, wait: WaitQuery = 0, prefer: PreferHeader = None
) -> Mesh:
    """Show facts and the hole list, once a worker has analysed the mesh."""
    wait_s = min(max(float(wait), preferred_wait_s(prefer)), services.settings.max_wait_s)
    mesh = await run_in_threadpool(services.meshes.get, mesh_id)
    has_waited = True
    if wait_s > 0 and mesh.state is MeshState.ANALYSING:
        has_waited = await services.mesh_waiters.wait(mesh_id_of(services.database.tenant, mesh_id), wait_s)
        mesh = await run_in_threadpool(services.meshes.get, mesh_id)
    if has_waited:
        note_applied(response, prefer)
    if mesh.state is MeshState.ANALYSING:
        response.headers["Retry-After"] = RETRY_AFTER_S
    return mesh


@router.get(
    "/v1/meshes/{mesh_id}/content",
    response_class=Response,
    dependencies=CONDITIONAL,
    responses={
        200: {"description": "The whole file.", "content": {"application/octet-stream": {"schema": BINARY}}},
        206: {"description": "The range.", "content": {"application/octet-stream": {"schema": BINARY}}},
        **not_modified(),
        **problems(404, 410, 412, 416),
    },
)
def get_mesh_content(
    request: Request,
    services: ServicesDep,
    mesh_id: MeshIdPath,
) -> Response:
    """Fetch the bytes, as uploaded."""
    mesh = services.meshes.get(mesh_id)
    source = services.meshes.source(mesh_id)
    name = mesh.filename or f"mesh-{mesh_id[:12]}"
    return content_response(request, services, Content(source.key, source.sha256, mesh.size_bytes, name))


def _known_bytes(services: Services, sha256: str) -> StoredObject | None:
    """Return the bytes of a mesh where they are there and sound, as far as that is known without reading them."""
    try:
        mesh, key = services.meshes.get(sha256), services.meshes.source(sha256).key
        size = services.store.size(key)
    except (MeshNotFoundError, ObjectNotFoundError):
        return None
    is_lost = mesh.problem is not None and mesh.problem.code in (MESH_MISSING, MESH_DAMAGED)
    return None if is_lost or size != mesh.size_bytes else StoredObject(key, size, sha256)


def register_mesh(
    services: Services, upload: Upload, filename: str | None, given: Format | None, *, is_counted: bool = False
) -> tuple[Mesh, bool]:
    """Note an upload and ask for its analysis; return the mesh, and whether it is new. `is_counted`: as for `add`."""
    assure(services.database, services.store, upload.stored.key)
    name = clean_filename(filename or upload.filename)
    mesh_format = stated_format(given, name, upload.content_type)
    mesh, is_new = services.meshes.add(upload.stored, name, mesh_format, is_counted=is_counted)
    if mesh.state is MeshState.ANALYSING:
        request_analysis(services, mesh.id)
    return mesh, is_new
