"""What the reports of all tasks share. Lengths are in the unit that `length_unit` of a report names.

A report of an earlier version may lack fields that came later, so those have defaults.

Tested in `tests/jobkit/schema/test_reports.py`.
"""

from typing import Any, Literal

from pydantic import Field

from jobkit.schema.base import Response

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
