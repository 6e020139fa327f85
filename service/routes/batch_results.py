"""What a batch has made: all results in a ZIP file, and a table of figures."""

from collections.abc import Iterator
from itertools import chain
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request
from starlette.responses import Response, StreamingResponse

from jobkit.errors import BatchNotFinishedError, ObjectDamagedError, ObjectNotFoundError
from jobkit.storage.damage import refuse_damaged
from jobkit.storage.digests import verified_chunks
from quadpatch_client.schema import FileRole, ResultFile
from service.batch_files import TABLE, FileNames, figures, jobs_of
from service.content import content_disposition
from service.head_requests import is_head
from service.routes.common import BINARY, BatchIdPath, problems
from service.services import Services, ServicesDep
from service.strict_validation import StrictRoute
from service.zip_stream import Entry, zip_stream

router = APIRouter(tags=["batches"], route_class=StrictRoute)

_CSV, _ZIP = "text/csv", "application/zip"
# Beyond what any table of figures has.
_TABLE_BYTES = 1 << 31
Roles = Annotated[
    list[FileRole] | None,
    Query(max_length=4, description="Which files of each job; may be repeated.", examples=[["result", "report"]]),
]


def _documented(media_type: str, schema: dict[str, Any], description: str) -> dict[int | str, dict[str, Any]]:
    return {200: {"description": description, "content": {media_type: {"schema": schema}}}}


@router.get(
    "/v1/batches/{batch_id}/figures.csv",
    response_class=Response,
    responses={
        **_documented(_CSV, {"type": "string"}, "A line for each job; names of columns say their units."),
        **problems(404),
    },
)
def get_batch_figures(request: Request, services: ServicesDep, batch_id: BatchIdPath) -> Response:
    """Fetch a table of the jobs of a batch, as they stand now."""
    services.batches.get(batch_id)
    lines = figures(jobs_of(services.jobs, batch_id))
    return _download(request, lines, f"{_CSV}; charset=utf-8", f"{batch_id}.csv")


@router.get(
    "/v1/batches/{batch_id}/results.zip",
    response_class=Response,
    responses={
        **_documented(_ZIP, dict(BINARY), "The files, and `figures.csv`; it is streamed, and says no length."),
        **problems(404, 409),
    },
)
def get_batch_results(request: Request, services: ServicesDep, batch_id: BatchIdPath, role: Roles = None) -> Response:
    """Fetch all results of a batch that has ended in one ZIP file; `figures.csv` in it names the file of each job."""
    if services.batches.get(batch_id).finished_at is None:
        raise BatchNotFinishedError(f"batch {batch_id} is under way; its jobs hand out their results one by one")
    table = Entry(TABLE, _TABLE_BYTES, figures(jobs_of(services.jobs, batch_id)))
    files = _files(services, batch_id, role or ["result"])
    return _download(request, zip_stream(chain([table], files)), _ZIP, f"{batch_id}.zip")


def _download(request: Request, chunks: Iterator[bytes], media_type: str, name: str) -> Response:
    headers = {"Content-Disposition": content_disposition(name), "Cache-Control": "no-store"}
    if is_head(request.scope):
        return Response(None, headers=headers, media_type=media_type)
    return StreamingResponse(chunks, headers=headers, media_type=media_type)


def _files(services: Services, batch_id: str, roles: list[FileRole]) -> Iterator[Entry]:
    """Yield the files of a batch. Each result is named, wanted or not, so that names are those of the table."""
    names = FileNames()
    for job in jobs_of(services.jobs, batch_id):
        if job.result is None:
            continue
        result_name = names.name(job)
        _, keys = services.jobs.with_files(job.id)
        for role in dict.fromkeys(roles):
            file = job.result.file(role)
            if file is not None:
                name = result_name if role == "result" else names.name(job, role)
                yield _entry(services, name, keys[file.name], file)


def _entry(services: Services, name: str, key: str, file: ResultFile) -> Entry:
    """Return a file, or a note in its place where it is known to be lost or damaged.

    Damage that shows while it is read breaks the archive off.
    """
    try:
        refuse_damaged(services.database, key)
        return Entry(name, file.size_bytes, verified_chunks(services.store.read(key), file.sha256))
    except (ObjectNotFoundError, ObjectDamagedError) as error:
        note = f"{error.code}: the store has lost this file; run the job again\n".encode()
        return Entry(f"{name}.missing.txt", len(note), [note])
