"""Headers of requests to `/v1/uploads`, as the protocol tus 1.0 and the document name them.

Tested in `tests/service/routes/test_uploads.py`.
"""

from typing import Annotated, Literal

from fastapi import Header
from pydantic import WithJsonSchema

from jobkit.uploads.uploads import NewUpload
from quadpatch_client.schema import UploadKind
from service.problems import invalid_request
from service.tus import CHECKSUMS, MAX_METADATA, read_joined, read_metadata

LARGEST = 2**53 - 1

ChecksumHeader = Annotated[
    str | None,
    Header(
        alias="Upload-Checksum",
        max_length=128,
        description=f"Algorithm ({', '.join(CHECKSUMS)}) and digest of this body in base64; bytes that don't fit it "
        "are not kept.",
        examples=["sha256 n4bQgYhMfWWaL+qgxVrQFaO/TxsrC4Is0V1sFbDwCgg="],
    ),
]


def version_header(
    version: Annotated[
        Literal["1.0.0"],
        # Generators of clients take an enumeration for a header, and no constant.
        WithJsonSchema({"type": "string", "enum": ["1.0.0"]}),
        Header(alias="Tus-Resumable", description="Version of the protocol."),
    ],
) -> None:
    """Document the header that `service.tus` reads."""


async def read_creation(
    length: Annotated[
        int | None,
        Header(
            alias="Upload-Length",
            ge=1,
            le=LARGEST,
            description="Bytes of the file; needed unless it joins others.",
            examples=[209_715_200],
        ),
    ] = None,
    metadata: Annotated[
        str | None,
        Header(
            alias="Upload-Metadata",
            max_length=MAX_METADATA,
            description="Pairs of a key and a value in base64: `filename`, `format` or `filetype`, and `sha256`, which "
            "the bytes must have (64 hexadecimal digits).",
            examples=["filename ZmFjZTAwMC5wbHk="],
        ),
    ] = None,
    concat: Annotated[
        str | None,
        Header(
            alias="Upload-Concat",
            pattern=r"^(partial|final;[!-~ ]+)$",
            description="`partial`, or `final;` and the paths of the partial uploads to join, with spaces between.",
            examples=["partial"],
        ),
    ] = None,
) -> NewUpload:
    """Return what the headers of a creation say; raise ProblemError, 422, where that is too little or nonsense."""
    facts = read_metadata(metadata)
    joins = read_joined(concat) if concat is not None and concat.startswith("final;") else ()
    kind = UploadKind.FINAL if joins else UploadKind.WHOLE if concat is None else UploadKind.PARTIAL
    if (length is None) != (kind is UploadKind.FINAL):
        message = "Field required" if length is None else "an upload that joins others has the length of all of them"
        code = "missing" if length is None else "value_error"
        raise invalid_request([{"loc": ("header", "Upload-Length"), "msg": message, "type": code}])
    return NewUpload(kind, length or 0, facts.filename, facts.format, facts.sha256, metadata, concat, joins)
