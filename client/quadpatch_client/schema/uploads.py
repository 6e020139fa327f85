"""Resumable uploads as clients see them.

Tested in `tests/service/routes/test_uploads.py`.
"""

from enum import StrEnum

from pydantic import Field

from quadpatch_client.schema.base import MeshId, Moment, Response, Sha256
from quadpatch_client.schema.spec import Format
from quadpatch_rules.ids import UPLOAD_ID_PATTERN

EXAMPLE_UPLOAD_ID = "upl_01jd7z3v5qk8m2x4c6b8n0a9de"


class UploadState(StrEnum):
    """Where an upload stands."""

    OPEN = "open"
    COMPLETED = "completed"
    FAILED = "failed"


class UploadKind(StrEnum):
    """What becomes of the bytes of an upload: a mesh, or a part of one that a final upload joins."""

    WHOLE = "whole"
    PARTIAL = "partial"
    FINAL = "final"


class UploadProblem(Response):
    """Why an upload failed."""

    code: str = Field(description="Stable code.", examples=["digest_mismatch"])
    message: str = Field(description="A sentence for people.", examples=["the bytes have another sha256"])


class UploadLinks(Response):
    """Paths on this service."""

    self: str = Field(description="This upload.")
    mesh: str | None = Field(default=None, description="The mesh that it became.")


class Upload(Response):
    """A resumable upload."""

    id: str = Field(pattern=UPLOAD_ID_PATTERN, description="Id of an upload.", examples=[EXAMPLE_UPLOAD_ID])
    kind: UploadKind = Field(description="`whole`, `partial`, or `final`, which joins partial ones.")
    state: UploadState = Field(
        description="`open`: bytes are to come, or to be put together; `completed`: the mesh is there, or the partial "
        "upload is whole; `failed`: nothing of it is kept, and `problem` says why.",
        examples=["open"],
    )
    offset_bytes: int = Field(ge=0, description="Bytes that have arrived and are stored.", examples=[8_388_608])
    size_bytes: int = Field(ge=1, description="Bytes of the whole.", examples=[209_715_200])
    filename: str | None = Field(default=None, description="Name of the file.", examples=["face000.ply"])
    format: Format | None = Field(default=None, description="Format, as stated; null: not stated.", examples=["ply"])
    sha256: Sha256 | None = Field(default=None, description="That the bytes must have; null: none was stated.")
    upload_metadata: str | None = Field(default=None, description="`Upload-Metadata`, as it was sent.")
    upload_concat: str | None = Field(default=None, description="`Upload-Concat`, as it was sent.")
    mesh_id: MeshId | None = Field(default=None, description="The mesh that it became; null: not yet, or partial.")
    problem: UploadProblem | None = Field(default=None, description="Set once the state is `failed`.")
    created_at: Moment = Field(description="When it was made, RFC 3339.")
    expires_at: Moment = Field(description="When it is removed unless more bytes come, RFC 3339.")
    links: UploadLinks = Field(description="Paths on this service.")

    @property
    def has_all_bytes(self) -> bool:
        """Whether every byte has arrived."""
        return self.offset_bytes == self.size_bytes
