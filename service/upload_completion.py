"""From the parts of a resumable upload to a mesh, exactly once.

The bytes are read from the parts, held against their sha256, and written as those of any other upload, so a mesh whose
bytes lie in the store is whole and on the disk. Each step may be repeated: the key of a mesh follows from its bytes,
and its row is made once. A process that dies before the upload is marked as completed leaves it to the next request
that asks for the upload, which does all of it again.

Tested in `tests/service/routes/test_uploads.py`.
"""

from functools import partial
from http import HTTPStatus

from starlette.concurrency import run_in_threadpool

from jobkit.errors import ObjectDamagedError, ObjectNotFoundError
from jobkit.storage.base import StoredObject
from jobkit.storage.digests import verified_chunks
from quadpatch_client.schema import Upload, UploadKind, UploadProblem, UploadState
from service import uploads as uploading
from service.problems import ProblemError
from service.routes.meshes import MESH_PREFIX, register_mesh
from service.services import Services
from service.upload_parts import drop_objects

_DAMAGED = UploadProblem(code="upload_damaged", message="bytes of the upload are gone from the store, or have changed")
_WRONG = UploadProblem(
    code="digest_mismatch", message="the bytes have another sha256 than Upload-Metadata states; nothing of them is kept"
)


class _WrongDigestError(Exception):
    """The bytes are not those that the client has announced."""


async def completed(services: Services, upload: Upload, wait_s: float) -> Upload:
    """Return an upload as it is once its mesh is there, or after `wait_s` seconds."""
    if upload.state is not UploadState.OPEN or not upload.has_all_bytes or upload.kind is UploadKind.PARTIAL:
        return upload
    await services.completions.run(f"completion of {upload.id}", partial(_complete, services, upload), wait_s)
    return await run_in_threadpool(services.uploads.get, upload.id)


def refuse_failed(upload: Upload) -> None:
    """Raise ProblemError, 410, with the reason why an upload has failed."""
    if upload.problem is not None:
        raise ProblemError(HTTPStatus.GONE, upload.problem.code, upload.problem.message)


def _complete(services: Services, upload: Upload) -> None:
    try:
        stored = _put_together(services, upload)
    except (ObjectDamagedError, ObjectNotFoundError):
        # Where another process has completed it meanwhile, its parts are gone, and this changes nothing.
        keys = services.uploads.fail(upload.id, _DAMAGED)
    except _WrongDigestError:
        keys = services.uploads.fail(upload.id, _WRONG)
    else:
        whole = uploading.Upload(stored, upload.filename, "")
        mesh, _ = register_mesh(services, whole, None, upload.format, is_counted=True)
        keys = services.uploads.complete(upload.id, mesh.id)
    drop_objects(services.store, keys)


def _put_together(services: Services, upload: Upload) -> StoredObject:
    size = 0
    with services.store.writer(MESH_PREFIX) as writer:
        for part in services.uploads.parts(upload.id):
            for chunk in verified_chunks(services.store.read(part.key), part.sha256):
                writer.write(chunk)
                size += len(chunk)
        if size != upload.size_bytes:
            raise ObjectDamagedError(f"the parts of upload {upload.id} have {size} bytes")
        if upload.sha256 not in (None, writer.sha256):
            raise _WrongDigestError
        return writer.commit()
