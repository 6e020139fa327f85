"""Keys of clients, and the audit log, as clients see them.

Tested in `tests/service/routes/test_keys.py`.
"""

from enum import StrEnum
from typing import Annotated, Any

from pydantic import Field

from quadpatch_client.schema.base import TEXT_PATTERN, WHOLE, Moment, Request, Response, SentMoment
from quadpatch_rules.ids import KEY_ID_PATTERN, TENANT_PATTERN

EXAMPLE_KEY_ID = "key_01jd7z3v5qk8m2x4c6b8n0a9de"
EXAMPLE_KEY = "qpk_3Jx8v0Yw2n5q7c1b9m4k6t8r0e2a5d7f9h1j3l5"


class Scope(StrEnum):
    """What a key may do."""

    READ = "read"
    UPLOAD = "upload"
    REPAIR = "repair"
    MODELS = "models"
    ADMIN = "admin"


KeyId = Annotated[str, Field(pattern=KEY_ID_PATTERN, description="Id of a key.", examples=[EXAMPLE_KEY_ID])]
Tenant = Annotated[
    str,
    Field(
        pattern=TENANT_PATTERN,
        description="Whose meshes, jobs, models and subscriptions it reaches. `default` is the operator's own.",
        examples=["plant-north"],
    ),
]
KeyName = Annotated[
    str,
    Field(min_length=1, max_length=64, pattern=TEXT_PATTERN, description="A name for people.", examples=["station 4"]),
]
Scopes = Annotated[
    list[Annotated[Scope, Field(strict=False)]],
    Field(
        min_length=1,
        description="`read`: look at everything and download it; `upload`: send meshes, pin and delete them; `repair`: "
        "start, cancel and delete jobs, subscribe to events; `models`: publish models and move aliases; `admin`: make "
        "and revoke keys, read the audit log and the metrics.",
        examples=[["read", "upload", "repair"]],
    ),
]


KeyRate = Annotated[
    int | None,
    Field(
        ge=1,
        le=2**31,
        description="Requests within a minute, besides those that the tenant may send in all; null: no limit of its "
        "own.",
        examples=[600],
    ),
    WHOLE,
]


class NewKey(Request):
    """A key to make."""

    name: KeyName
    tenant: Tenant | None = Field(default=None, description="null: that of the key that asks.")
    scopes: Scopes = Field(default=[Scope.READ, Scope.UPLOAD, Scope.REPAIR])
    expires_at: SentMoment | None = Field(
        default=None, description="When it is no longer taken, RFC 3339; null: never."
    )
    requests_per_minute: KeyRate = None

    def model_post_init(self, _context: Any) -> None:
        """Name each scope once, in one order."""
        self.scopes = [scope for scope in Scope if scope in self.scopes]


class KeyChanges(Request):
    """What is to be another thing of a key; what is not named stays."""

    requests_per_minute: KeyRate = None


class Key(Response):
    """A key, without the secret."""

    id: KeyId
    name: KeyName
    tenant: Tenant
    scopes: Scopes
    requests_per_minute: KeyRate = None
    created_at: Moment = Field(description="When it was made, RFC 3339.")
    used_at: Moment | None = Field(
        default=None, description="When it was used last, to within a minute, RFC 3339; null: never."
    )
    expires_at: Moment | None = Field(default=None, description="When it is no longer taken, RFC 3339; null: never.")
    revoked_at: Moment | None = Field(default=None, description="When it was revoked, RFC 3339; null: it was not.")
    old_until: Moment | None = Field(
        default=None, description="Until when the key of before the rotation is taken as well, RFC 3339."
    )


class KeyWithSecret(Key):
    """A key, as it is shown once."""

    key: str = Field(description="What clients send. It is not stored, and not shown again.", examples=[EXAMPLE_KEY])


class KeyList(Response):
    """Keys, oldest first."""

    items: list[Key] = Field(description="Those that are revoked or expired stay here.")


class AuditEntry(Response):
    """A request that changed something, or was refused for want of a right."""

    id: str = Field(description="Ids sort by age.", examples=["aud_01jd7z3v5qk8m2x4c6b8n0a9de"])
    at: Moment = Field(description="When it was answered, RFC 3339.")
    tenant: Tenant
    principal: str = Field(
        description="Who asked: the id of a key, `local` for requests without one from this machine.",
        examples=[EXAMPLE_KEY_ID],
    )
    name: str | None = Field(default=None, description="The name of the key.", examples=["station 4"])
    operation: str = Field(description="`operationId` of the request, as in this document.", examples=["delete_job"])
    path: str = Field(description="Path of the request.", examples=["/v1/jobs/job_01jd7z3v5qk8m2x4c6b8n0a9de"])
    status: int = Field(description="HTTP status of the answer.", examples=[204])
    address: str | None = Field(default=None, description="Address that the request came from.", examples=["10.0.4.17"])
    request_id: str | None = Field(default=None, description="`X-Request-Id` of the answer.", examples=["station-4-17"])


class AuditPage(Response):
    """One page of the audit log, newest first."""

    items: list[AuditEntry] = Field(description="Entries.")
    next_cursor: str | None = Field(default=None, description="Pass as `cursor` to go on; null on the last page.")
