"""What the reports of all tasks share. Lengths are in the unit that `length_unit` of a report names.

A report of an earlier version may lack fields that came later, so those have defaults.

Tested in `tests/quadpatch_client/schema/test_reports.py`.
"""

from typing import Any, Literal

from pydantic import Field

from quadpatch_client.schema.acceptance import Acceptance
from quadpatch_client.schema.base import EXAMPLE_JOB_ID, Response, Sha256
from quadpatch_client.schema.codes import WarningDetails

Vector = list[float]
ReportSchema = Literal[1]


class Box(Response):
    """A box along the axes."""

    min: Vector = Field(description="Its smallest coordinates, in mesh units.", examples=[[-1.0, -1.0, -0.5]])
    max: Vector = Field(description="Its largest coordinates, in mesh units.", examples=[[1.0, 1.0, 0.5]])


class SourceMesh(Response):
    """The mesh that came in."""

    format: str = Field(description="Format of the file.", examples=["ply"])
    vertices: int = Field(ge=0, description="Vertices in the file.", examples=[85_182])
    triangles: int = Field(ge=0, description="Triangles in the file, polygons cut.", examples=[168_702])
    bounding_box: Box = Field(description="Box around all vertices.")
    mean_edge_length: float | None = Field(description="Mean length of an edge, in mesh units.", examples=[0.02])


class Welded(Response):
    """How the file's triangles became one surface."""

    equal_vertices: int = Field(ge=0, description="Vertices joined to an earlier one at the same place.", examples=[0])
    near_vertices: int = Field(ge=0, description="Vertices joined to one within the tolerance.", examples=[0])
    tolerance: float = Field(ge=0, description="In mesh units.", examples=[1e-06])
    triangles: int = Field(ge=0, description="Triangles with three different corners.", examples=[168_702])
    duplicate_triangles: int = Field(ge=0, description="Ignored as copies of others.", examples=[0])
    fin_triangles: int = Field(
        ge=0, description="Ignored: they hang on edges that have two triangles already.", examples=[0]
    )
    turned_triangles: int = Field(
        ge=0, description="Taken for facing the other way than the file has them.", examples=[0]
    )


class Patches(Response):
    """The patches that a model works on."""

    length: float = Field(description="Side of a patch, in mesh units.", examples=[0.4])
    resolution: int = Field(ge=1, description="Bins along a side.", examples=[16])
    overlap: int = Field(ge=0, description="How many patches see a point on average.", examples=[2])
    count: int = Field(ge=0, description="How many there are.", examples=[154])


class AppliedPatches(Patches):
    """The patches that a model works on, and how much of what it says was applied."""

    believed_share: float = Field(description="Share of the model's displacement that was applied.", examples=[0.8])


class FileFacts(Response):
    """A file, by its bytes."""

    name: str = Field(description="Its name.", examples=["face000.ply"])
    size_bytes: int = Field(ge=0, description="Size, in bytes.", examples=[3_300_000])
    sha256: Sha256


class SurfaceFacts(Response):
    """Figures of a surface: repeated vertices joined, repeated faces and fins left out."""

    triangles: int = Field(ge=0, description="How many.", examples=[168_702])
    boundary_loops: int = Field(ge=0, description="How many.", examples=[45])
    boundary_length: float | None = Field(description="Of all loops together, in mesh units.", examples=[812.5])
    area: float | None = Field(description="Area, in square units.", examples=[23_410.0])
    volume: float | None = Field(
        description="Enclosed, in cubic units, negative where the surface faces inwards; null where it is not "
        "watertight."
    )
    components: int = Field(ge=0, description="Pieces that share no vertex.", examples=[1])
    is_watertight: bool = Field(
        description="Whether each edge has exactly two triangles, which pass it in opposite directions."
    )


class CountedValues(Response):
    """A histogram."""

    edges: list[float] = Field(description="Bounds of the bins, one more than there are bins.", examples=[[0.0, 0.1]])
    counts: list[int] = Field(description="Values in each bin.", examples=[[12]])


class Asked(Response):
    """Who asked for a job."""

    job_id: str = Field(description="The job.", examples=[EXAMPLE_JOB_ID])
    tenant: str = Field(description="The tenant that it belongs to.", examples=["default"])
    asked_by: str | None = Field(
        default=None,
        description="The key that the request came with, by its name (`settings` for those of the settings); of an "
        "OIDC token the digest that the audit log has; left out where no key was needed.",
        examples=["station 4"],
    )
    request_id: str | None = Field(description="The request that made the job; the audit log has more about it.")
    label: str | None = Field(description="Name of the job for people.", examples=["station 4, part 1187"])
    metadata: dict[str, str] = Field(description="Facts of the sender's own.", examples=[{"order": "A-17"}])
    rule: str | None = Field(description="The saved rule that the job went by.", examples=["castings@2"])
    acceptance: Acceptance | None = Field(default=None, description="Limits that the job had; null where it had none.")


class Provenance(Response):
    """From which bytes a task made which, when, by what, for whom; and the surface before and after."""

    software: str = Field(description="What repaired it.", examples=["quadpatch"])
    software_version: str = Field(description="Its version.", examples=["0.2.0"])
    started_at: str = Field(description="RFC 3339, UTC.", examples=["2026-11-30T09:15:02.250Z"])
    finished_at: str = Field(description="When the mesh was written, RFC 3339, UTC.")
    source: FileFacts | None = Field(description="The file that came in; null of a stream.")
    output: FileFacts | None = Field(description="The file that was written; null of a stream.")
    request: Asked | None = Field(description="Who asked over HTTP; null on the command line.")
    before: SurfaceFacts | None = Field(description="The surface that came in; null of `decode`, which gets none.")
    after: SurfaceFacts = Field(description="The surface that is handed back.")
    displacement: CountedValues | None = Field(
        description="How far the model moved new vertices off the geometric fill, in mesh units; null where it took no "
        "part."
    )


class StageTime(Response):
    """One stage of the method."""

    name: str = Field(description="The stage.", examples=["inpaint"])
    seconds: float = Field(ge=0, description="How long it took, in seconds.", examples=[1.42])
    peak_memory_mib: int = Field(
        ge=0, description="Most memory that the process had had by its end, in MiB.", examples=[312]
    )


class TaskReport(Response):
    """What the reports of all tasks begin with."""

    schema_: ReportSchema = Field(alias="schema", description="Version of this form.", examples=[1])
    length_unit: str = Field(description="Unit of all lengths: that of the file.", examples=["millimeter"])
    model: dict[str, Any] = Field(
        description="The model that was used: its `name` and, where it has them, `version`, `kind` and `sha256`.",
        examples=[{"name": "self"}],
    )
    options: dict[str, Any] = Field(description="What the task was told, defaults written out.", examples=[{"seed": 0}])
    stages: list[StageTime] = Field(description="Seconds of each stage, in order.")
    warnings: list[str] = Field(description="Sentences for people.", examples=[[]])
    warning_details: WarningDetails = Field(default_factory=list)
    provenance: Provenance | None = Field(
        default=None,
        description="Files, times, who asked, and the surface before and after; there where the report was asked for "
        "as a page as well.",
    )
