"""The report of a training, as `GET /v1/jobs/{job_id}/report` hands it out.

Tested in `tests/quadpatch_client/schema/test_reports.py`.
"""

from typing import Literal

from pydantic import Field

from quadpatch_client.schema.base import Response
from quadpatch_client.schema.codes import WarningDetails
from quadpatch_client.schema.learning import JudgedMesh, TrainedKind
from quadpatch_client.schema.report_parts import ReportSchema, StageTime


class TrainReport(Response):
    """The report of `train`."""

    schema_: ReportSchema = Field(alias="schema", description="Version of this form.", examples=[1])
    task: Literal["train"] = Field(description="What was done.", examples=["train"])
    stages: list[StageTime] = Field(description="Seconds of each stage, in order.")
    learned_from: list[str] = Field(description="Ids of the meshes that it was learned from.")
    kind: TrainedKind = Field(default="dictionary", description="What was learned.", examples=["dictionary"])
    patches: int = Field(
        ge=0, description="Patches, or training pairs of a network, that it was learned from.", examples=[12_000]
    )
    learning_errors: list[float] = Field(
        description="Of a dictionary: root mean square error on the patches after each round of K-SVD; 1 is their own. "
        "Of a network: its loss on training pairs that it does not learn from, five times over its steps.",
        examples=[[0.16, 0.11, 0.09]],
    )
    judged: list[JudgedMesh] = Field(description="Errors beside the plain fill, for each mesh that was held out.")
    verdict: str = Field(description="A sentence for people.", examples=["worse than the plain fill on 3 of 4 meshes"])
    is_better: bool = Field(description="Whether it is better than the plain fill, all in all.")
    warnings: list[str] = Field(description="Sentences for people.", examples=[[]])
    warning_details: WarningDetails = Field(default_factory=list)
