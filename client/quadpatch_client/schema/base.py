"""What all wire models share.

A request that holds an unknown or wrongly typed field is refused. A response may grow fields later: a client reads
those it knows, so models of responses ignore the rest.

Tested in `tests/quadpatch_client/schema/test_spec.py`.
"""

import re
from datetime import datetime
from typing import Annotated

from pydantic import AwareDatetime, BaseModel, BeforeValidator, ConfigDict, Field, PlainSerializer

from quadpatch_rules.ids import BATCH_ID_PATTERN, JOB_ID_PATTERN, MODEL_NAME, SHA256_PATTERN

# Without control characters: PostgreSQL stores no NUL, and a line break in a label breaks every log.
TEXT_PATTERN = r"^[^\x00-\x1f\x7f]*$"
NAME_PATTERN = rf"^{MODEL_NAME}$"
REFERENCE_PATTERN = rf"^{MODEL_NAME}(@[1-9][0-9]{{0,8}})?$"
_RFC3339 = re.compile(r"^\d{4}-\d\d-\d\d[Tt ]\d\d:\d\d:\d\d(\.\d+)?([Zz]|[+-]\d\d:\d\d)$", re.ASCII)
EXAMPLE_SHA256 = "3b1f5b1a4c6e5d7a9f0c2b4d6e8f10213243546576879809a1b2c3d4e5f60718"
EXAMPLE_JOB_ID = "job_01jd7z3v5qk8m2x4c6b8n0a9de"
EXAMPLE_BATCH_ID = "bat_01jd7z3v5qk8m2x4c6b8n0a9de"


class Request(BaseModel):
    """A model that clients send: strict types, nothing unknown, no infinities."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)


class Response(BaseModel):
    """A model that the service sends."""

    model_config = ConfigDict(extra="ignore", allow_inf_nan=False)


def rfc3339(moment: datetime) -> str:
    """Write a moment as RFC 3339 in UTC with milliseconds, like 2026-11-22T09:15:02.250Z."""
    return moment.isoformat(timespec="milliseconds").replace("+00:00", "Z")


def _whole_number(value: object) -> object:
    """Take 24.0 for 24: JSON knows one kind of number only."""
    return int(value) if isinstance(value, float) and value.is_integer() else value


def _is_rfc3339(value: object) -> object:
    if isinstance(value, str) and not _RFC3339.match(value):
        raise ValueError("write a moment as RFC 3339 does, like 2026-11-22T09:15:02Z")
    if not isinstance(value, str | datetime):
        raise ValueError("write a moment as a text, like 2026-11-22T09:15:02Z")
    return value


# To stand last, so that it comes first and the bounds show in the document.
WHOLE = BeforeValidator(_whole_number)
Moment = Annotated[
    datetime,
    PlainSerializer(rfc3339, return_type=str, when_used="json"),
    Field(json_schema_extra={"format": "date-time"}, examples=["2026-11-22T09:15:02.250Z"]),
]
# As clients send it: a number of seconds, which pydantic takes as well, is none.
SentMoment = Annotated[
    AwareDatetime,
    Field(strict=False),
    BeforeValidator(_is_rfc3339),
    Field(json_schema_extra={"format": "date-time"}, examples=["2026-11-22T09:15:02.250Z"]),
]
JobId = Annotated[
    str, Field(pattern=JOB_ID_PATTERN, description="Id of a job; ids sort by age.", examples=[EXAMPLE_JOB_ID])
]
BatchId = Annotated[
    str, Field(pattern=BATCH_ID_PATTERN, description="Id of a batch; ids sort by age.", examples=[EXAMPLE_BATCH_ID])
]
MeshId = Annotated[
    str,
    Field(
        pattern=SHA256_PATTERN, description="Id of a mesh: the sha256 of its bytes, in hex.", examples=[EXAMPLE_SHA256]
    ),
]
Sha256 = Annotated[
    str, Field(pattern=SHA256_PATTERN, description="sha256 of the bytes, in hex.", examples=[EXAMPLE_SHA256])
]
ModelName = Annotated[str, Field(pattern=NAME_PATTERN, description="Name of a model.", examples=["general-dictionary"])]
AliasName = Annotated[
    str,
    Field(
        pattern=NAME_PATTERN,
        description="A name that points to a model version and can be moved.",
        examples=["default"],
    ),
]
ModelReference = Annotated[
    str,
    Field(
        pattern=REFERENCE_PATTERN,
        description="`name@version`, `name` (its latest version) or an alias.",
        examples=["general-dictionary@1"],
    ),
]
