"""Codes of what goes wrong with jobs, meshes and models after they were accepted, and of warnings.

Tested in `tests/test_documents.py`.
"""

from collections.abc import Iterable
from typing import Annotated, Any

from pydantic import Field, WithJsonSchema

from quadpatch_client.schema.base import Response
from quadpatch_rules.coded_warnings import OTHER, WARNINGS

FAILURE_CODES = (
    # Of the method, about a file or an option.
    "unreadable_mesh",
    "unsupported_format",
    "mesh_encoded",
    "empty_mesh",
    "not_finite",
    "coordinate_out_of_range",
    "precision_lost",
    "index_out_of_range",
    "mesh_too_large",
    "invalid_option",
    "unusable_model",
    "torch_missing",
    "stage_failed",
    "no_quads",
    # Of the worker, about an attempt.
    "out_of_memory",
    "time_limit_exceeded",
    "result_too_large",
    "acceptance_not_met",
    "model_name_taken",
    "mesh_damaged",
    "mesh_missing",
    "proof_failed",
    "model_missing",
    "model_damaged",
    "store_unavailable",
    "engine_error",
    "engine_crashed",
    "process_lost",
    "no_space",
    "disk_error",
    "worker_lost",
    "queue_time_exceeded",
    "total_time_exceeded",
    "worker_drained",
    "analysis_failed",
)


def open_enum(values: Iterable[str], **more: Any) -> dict[str, Any]:
    """Return the JSON schema of a text whose known values are listed, and which may get further ones."""
    return {"anyOf": [{"type": "string", "enum": list(values)}, {"type": "string"}], **more}


FailureCode = Annotated[
    str,
    WithJsonSchema(
        open_enum(
            FAILURE_CODES,
            description="Stable code, meant for programs; versions to come may have others.",
            examples=["unreadable_mesh"],
        )
    ),
]

WarningCode = Annotated[
    str,
    WithJsonSchema(
        open_enum(
            (*WARNINGS, OTHER),
            description="Stable code, meant for programs; versions to come may have others.",
            examples=["copies_ignored"],
        )
    ),
]


class WarningDetail(Response):
    """A warning for programs, such as one that says it in another language."""

    code: WarningCode
    message: str = Field(description="The sentence that stands in `warnings`.", examples=["3 faces are exact copies"])
    values: dict[str, str | int | float] = Field(
        default_factory=dict,
        description="What stands in the sentence, by name; lengths are in mesh units.",
        examples=[{"copies": 3}],
    )


WarningDetails = Annotated[
    list[WarningDetail],
    Field(description="The same with codes; empty in what earlier versions wrote."),
]
