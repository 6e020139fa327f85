"""Resumable uploads by the protocol tus 1.0 (https://tus.io/protocols/resumable-upload).

Deferred lengths are not offered: the size of a file is known before it is sent, and is what room is kept for.
"""

from datetime import datetime
from email.utils import format_datetime
from functools import partial
from http import HTTPStatus
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Header, Path, Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from jobkit.errors import TooLargeError
from jobkit.uploads.uploads import NewUpload, offset_error, refuse_final
from quadpatch_client.schema import Upload, UploadKind
from quadpatch_client.schema.uploads import EXAMPLE_UPLOAD_ID
from quadpatch_rules.ids import UPLOAD_ID_PATTERN
from service.body_limit import has_body
from service.digests import StatedDigests, refuse_coding
from service.head_requests import is_head
from service.idempotency import note_replayed
from service.problems import ProblemError
from service.routes.common import BINARY, CallerDep, described_header, json_response, linked, problems
from service.routes.upload_headers import LARGEST, ChecksumHeader, read_creation, version_header
from service.services import Services, ServicesDep
from service.strict_validation import StrictRoute
from service.tus import (
    CHECKSUMS,
    CONTENT_TYPE,
    EXTENSIONS,
    VERSION,
    Checksum,
)
from service.upload_completion import completed, refuse_failed
from service.upload_parts import Check, append, drop_objects

router = APIRouter(tags=["uploads"], route_class=StrictRoute)
UploadIdPath = Annotated[
    str, Path(pattern=UPLOAD_ID_PATTERN, description="Id of an upload.", examples=[EXAMPLE_UPLOAD_ID])
]
_BODY: dict[str, Any] = {
    "requestBody": {
        "required": False,
        "description": "Bytes of the file, from the offset on.",
        "content": {CONTENT_TYPE: {"schema": BINARY}},
    }
}
_OFFSET = described_header("Bytes that have arrived and are stored.")
_EXPIRES = described_header("When it is removed unless more bytes come, as HTTP writes dates.")
_MESH = {"description": "Path of the mesh; only once that is there.", "schema": {"type": "string"}}
_HEADERS = {"Upload-Offset": _OFFSET, "Upload-Expires": _EXPIRES, "Quadpatch-Mesh": _MESH}


_TUS = [Depends(version_header)]


@router.options(
    "/v1/uploads",
    status_code=204,
    response_class=Response,
    responses={
        204: {
            "headers": {
                "Tus-Version": described_header("Versions of the protocol."),
                "Tus-Extension": described_header("Its extensions that are offered."),
                "Tus-Max-Size": described_header("Largest upload, in bytes."),
                "Tus-Checksum-Algorithm": described_header("Algorithms of `Upload-Checksum`."),
            }
        },
        **problems(),
    },
)
def describe_uploads(services: ServicesDep) -> Response:
    """Say what of the protocol tus is offered."""
    headers = {
        "Tus-Version": VERSION,
        "Tus-Extension": EXTENSIONS,
        "Tus-Max-Size": str(_max_bytes(services)),
        "Tus-Checksum-Algorithm": ",".join(CHECKSUMS),
    }
    return Response(status_code=HTTPStatus.NO_CONTENT, headers=headers)


@router.post(
    "/v1/uploads",
    status_code=201,
    response_model=Upload,
    responses={
        201: {
            "description": "The upload is there, with the bytes of the body, if there were any.",
            "headers": {"Location": described_header("Path of the upload."), **_HEADERS},
            "links": {"upload": linked("get_upload", "$response.body#/id", "upload_id")},
        },
        **problems(400, 404, 409, 410, 412, 413, 415, 460, 507),
    },
    openapi_extra=_BODY,
    dependencies=_TUS,
)
async def create_upload(
    request: Request,
    services: ServicesDep,
    caller: CallerDep,
    new: Annotated[NewUpload, Depends(read_creation)],
    checksum: ChecksumHeader = None,
) -> Response:
    """Start a resumable upload; the body may hold its first bytes."""
    begins = has_body(request.scope)
    if begins:
        _refuse_body(request)
        if new.kind is UploadKind.FINAL:
            raise ProblemError(HTTPStatus.BAD_REQUEST, "unexpected_body", "an upload that joins others takes no body")
    if new.size_bytes <= _max_bytes(services):
        await run_in_threadpool(partial(services.room.check, new.size_bytes, is_resumable=True))
    idempotency = caller.idempotency(
        "create_upload", str(new.size_bytes), new.upload_metadata or "", new.upload_concat or ""
    )
    upload, is_new = await run_in_threadpool(services.uploads.create, new, idempotency)
    if begins and is_new:
        upload = await _append(request, services, upload, checksum)
    upload = await completed(services, upload, services.settings.max_wait_s)
    refuse_failed(upload)
    response = json_response(upload, HTTPStatus.CREATED, Location=upload.links.self)
    return note_replayed(_described(response, upload), is_new=is_new)


@router.get(
    "/v1/uploads/{upload_id}",
    response_model=Upload,
    responses={
        200: {
            "headers": {
                **_HEADERS,
                "Upload-Length": described_header("Bytes of the file."),
                "Upload-Metadata": {"description": "As it was sent.", "schema": {"type": "string"}},
                "Upload-Concat": {"description": "As it was sent.", "schema": {"type": "string"}},
            }
        },
        **problems(404),
    },
)
async def get_upload(request: Request, services: ServicesDep, upload_id: UploadIdPath) -> Response:
    """Show an upload. `HEAD` says the same in headers, and is answered with 410 where the upload has failed."""
    upload = await run_in_threadpool(services.uploads.get, upload_id)
    upload = await completed(services, upload, services.settings.max_wait_s)
    if is_head(request.scope):
        refuse_failed(upload)
    response = _described(json_response(upload), upload)
    response.headers["Upload-Length"] = str(upload.size_bytes)
    if upload.upload_metadata is not None:
        response.headers["Upload-Metadata"] = upload.upload_metadata
    if upload.upload_concat is not None:
        response.headers["Upload-Concat"] = upload.upload_concat
    return response


@router.patch(
    "/v1/uploads/{upload_id}",
    status_code=204,
    response_class=Response,
    responses={
        204: {"description": "The bytes are stored.", "headers": _HEADERS},
        **problems(400, 404, 409, 410, 412, 413, 415, 460, 507),
    },
    openapi_extra={"requestBody": {**_BODY["requestBody"], "required": True}},
    dependencies=_TUS,
)
async def continue_upload(
    request: Request,
    services: ServicesDep,
    upload_id: UploadIdPath,
    offset: Annotated[
        int,
        Header(
            alias="Upload-Offset",
            ge=0,
            le=LARGEST,
            description="Where the body begins: the offset of the upload.",
            examples=[0],
        ),
    ],
    checksum: ChecksumHeader = None,
) -> Response:
    """Add bytes to an upload. Those that have arrived when the line breaks are kept."""
    _refuse_body(request)
    upload = await run_in_threadpool(services.uploads.get, upload_id)
    refuse_failed(upload)
    refuse_final(upload)
    if offset != upload.offset_bytes:
        raise offset_error(upload_id, offset)
    upload = await _append(request, services, upload, checksum)
    upload = await completed(services, upload, services.settings.max_wait_s)
    refuse_failed(upload)
    return _described(Response(status_code=HTTPStatus.NO_CONTENT), upload)


@router.delete(
    "/v1/uploads/{upload_id}",
    status_code=204,
    response_class=Response,
    responses=problems(404, 412),
    dependencies=_TUS,
)
def delete_upload(services: ServicesDep, upload_id: UploadIdPath) -> Response:
    """Give an upload up, and delete its bytes. The mesh that it became stays."""
    drop_objects(services.store, services.uploads.delete(upload_id))
    return Response(status_code=HTTPStatus.NO_CONTENT)


def _refuse_body(request: Request) -> None:
    """Refuse a body that is not what the protocol sends."""
    refuse_coding(request.headers)
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != CONTENT_TYPE:
        detail = f"the body must be {CONTENT_TYPE}; it is {kind or 'of no stated type'}"
        raise ProblemError(HTTPStatus.UNSUPPORTED_MEDIA_TYPE, "unsupported_media_type", detail)


async def _append(request: Request, services: Services, upload: Upload, checksum: str | None) -> Upload:
    length = request.headers.get("content-length", "")
    if length.isdecimal() and int(length) > upload.size_bytes - upload.offset_bytes:
        raise TooLargeError(f"the upload is to have {upload.size_bytes} bytes, and more are announced")
    await run_in_threadpool(services.room.check_reserve)
    digests = StatedDigests("the body", request.headers.items())
    checks: list[Check] = [] if checksum is None else [Checksum(checksum)]
    if digests.are_stated:
        checks.append(digests)
    return await append(services.uploads, services.store, upload, request.stream(), checks)


def _described(response: Response, upload: Upload) -> Response:
    """Add the headers that say where an upload stands."""
    response.headers["Upload-Offset"] = str(upload.offset_bytes)
    response.headers["Upload-Expires"] = _http_date(upload.expires_at)
    if upload.links.mesh is not None:
        response.headers["Quadpatch-Mesh"] = upload.links.mesh
    return response


def _http_date(moment: datetime) -> str:
    return format_datetime(moment, usegmt=True)


def _max_bytes(services: Services) -> int:
    return services.settings.max_upload_mb << 20
