"""Errors as RFC 9457 problem documents."""

from pydantic import Field

from quadpatch_client.schema.base import Response

PROBLEM_MEDIA_TYPE = "application/problem+json"


class FieldError(Response):
    """One thing that is wrong with a request."""

    location: str = Field(description="`body`, `query`, `path` or `header`.", examples=["body"])
    pointer: str = Field(description="JSON pointer, or the name of a parameter.", examples=["/holes/max_diameter"])
    message: str = Field(description="A sentence for people.", examples=["Input should be greater than 0"])
    code: str = Field(description="Kind of the error.", examples=["greater_than"])
    values: dict[str, str | int | float] | None = Field(
        default=None, description="What the kind speaks of, by name, such as a bound.", examples=[{"gt": 0}]
    )


class ProblemQuota(Response):
    """The quota that a request was refused by."""

    limit: int = Field(description="What the tenant may have.", examples=[10_000])
    used: int = Field(description="What it had.", examples=[10_000])


class Problem(Response):
    """An error (RFC 9457)."""

    type: str = Field(description="URI of the kind of problem.", examples=["urn:quadpatch:problem:mesh_not_found"])
    title: str = Field(description="The kind of problem in words.", examples=["Not Found"])
    status: int = Field(ge=400, le=599, description="The HTTP status.", examples=[404])
    code: str = Field(description="Stable code, meant for programs.", examples=["mesh_not_found"])
    detail: str = Field(description="What went wrong this time.", examples=["there is no mesh 3b1f…"])
    instance: str = Field(
        description="This very occurrence: the request's id.",
        examples=["urn:quadpatch:request:d63eb55a-11a0-4400-a36b-f9604e3cf4a3"],
    )
    retryable: bool = Field(default=False, description="Whether the same request may succeed later.")
    errors: list[FieldError] = Field(default_factory=list, description="One entry per wrong field.")
    quota: ProblemQuota | None = Field(default=None, description="Of a quota alone: how much there was of how much.")
