"""Limits that the holes of a result have to meet, and which of them do not.

Tested in `tests/worker/test_acceptance.py`.
"""

from typing import Literal

from pydantic import Field

from quadpatch_client.schema.base import Request, Response

HoleFault = Literal["refused", "unknown", "expected_error", "error_share", "confidence"]


class Acceptance(Request):
    """What every chosen hole of a result has to meet. A hole that was refused, and stays open, never does."""

    max_expected_error: float | None = Field(
        default=None, gt=0, le=1e12, description="Largest expected error, in mesh units.", examples=[0.1]
    )
    max_error_share: float | None = Field(
        default=None,
        gt=0,
        le=1e3,
        description="Largest expected error as a share of the diameter of its hole.",
        examples=[0.02],
    )
    min_confidence: float | None = Field(default=None, ge=0, le=1, description="Least confidence.", examples=[0.5])
    otherwise: Literal["warn", "fail"] = Field(
        default="warn",
        description="What becomes of a job with a hole that does not: `warn` ends it as `succeeded_with_warnings`, "
        "`fail` as `failed` with the code `acceptance_not_met` and without a result.",
        examples=["warn"],
    )


class UnmetHole(Response):
    """A hole that does not meet the limits. Lengths are in mesh units."""

    id: int = Field(ge=0, description="Its id in the mesh's hole list.", examples=[3])
    faults: list[HoleFault] = Field(
        description="`refused`: it stays open; `unknown`: it has no figure that a limit asks for; else the limit.",
        examples=[["expected_error"]],
    )
    expected_error: float | None = Field(default=None, description="As in the report.", examples=[0.21])
    confidence: float | None = Field(default=None, description="As in the report.", examples=[0.4])


class Accepted(Response):
    """What came of the limits."""

    is_met: bool = Field(description="Whether every chosen hole meets them.")
    holes: int = Field(ge=0, description="Chosen holes.", examples=[12])
    unmet: list[UnmetHole] = Field(default_factory=list, description="Those that do not, by id.")
