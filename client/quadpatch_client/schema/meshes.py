"""Meshes and their holes as clients see them. Lengths are in mesh units; `unit` names them where the file does."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from quadpatch_client.schema.base import MeshId, Moment, Response
from quadpatch_client.schema.codes import FailureCode, WarningDetails
from quadpatch_client.schema.spec import Format
from quadpatch_client.schema.states import MeshState
from quadpatch_rules.hole_selection import HoleKind

Point = Annotated[list[float], Field(min_length=3, max_length=3)]


class BoundingBox(Response):
    """Corners of a box along the axes, in mesh units."""

    min: Point = Field(description="Smallest coordinates.", examples=[[-1.0, -1.0, 0.0]])
    max: Point = Field(description="Largest coordinates.", examples=[[1.0, 1.0, 2.0]])


class Hole(Response):
    """One boundary loop."""

    id: int = Field(ge=0, description="Counts from 0, widest first.", examples=[3])
    perimeter: float = Field(ge=0, description="Length of the rim, in mesh units.", examples=[31.4])
    diameter: float = Field(ge=0, description="Largest distance within the rim, in mesh units.", examples=[10.0])
    area: float = Field(ge=0, description="Area on the rim's best plane, in square mesh units.", examples=[78.5])
    planarity: float = Field(ge=0, description="Distance of the rim from its plane by its diameter; 0 is flat.")
    edges: int = Field(ge=0, description="Edges of the rim.", examples=[36])
    is_manifold: bool = Field(default=True, description="False where the rim can't be filled.")
    is_border: bool = Field(
        default=False, description="True for what looks like the outer border of a piece of the scan, not a hole in it."
    )
    kind: HoleKind = Field(
        default="hole",
        description="`hole`; `slit`, whose sides lie close together along its length; `open_end`, a planar rim that "
        "ends the object, such as the end of a tube; `border`, the outer border of a piece.",
        examples=["hole"],
    )
    centre: Point | None = Field(
        default=None,
        description="Mean of the rim, in mesh units; null in analyses by versions that did not say.",
        examples=[[12.5, -3.0, 40.1]],
    )
    normal: Point | None = Field(
        default=None, description="Unit vector that the hole faces; null like `centre`.", examples=[[0.0, 0.6, 0.8]]
    )
    bounding_box: BoundingBox | None = Field(default=None, description="Box around the rim; null like `centre`.")
    lies_in: list[int] = Field(
        default_factory=list,
        description="Ids of the holes that it lies in as the border of an island, the narrowest first, at most 16.",
        examples=[[0]],
    )

    @property
    def n_edges(self) -> int:
        """Edges of the rim."""
        return self.edges

    @model_validator(mode="before")
    @classmethod
    def _name_kind(cls, values: Any) -> Any:
        """Read the kind of a border from analyses by versions that knew holes and borders only."""
        if isinstance(values, dict) and "kind" not in values and values.get("is_border") is True:
            return {**values, "kind": "border"}
        return values


class FacingLoops(Response):
    """Two loops that face each other across a gap. A job joins them only where its `holes.bridges` names them."""

    holes: list[int] = Field(min_length=2, max_length=2, description="Their ids, the wider first.", examples=[[3, 17]])
    shape: Literal["ring", "strip"] = Field(
        description="`ring`: they face each other all around; `strip`: two outer borders do along a part of them.",
        examples=["ring"],
    )
    gap: float = Field(ge=0, description="Mean distance between the rims, in mesh units.", examples=[0.8])
    share: float = Field(
        ge=0, le=1, description="Of the rim that faces the other one, where it is smaller.", examples=[0.97]
    )


class EncodedFacts(Response):
    """What the header of a `.qpz` file says."""

    max_error: float = Field(
        ge=0, description="How far the decoded surface lies from the scan at most, in mesh units.", examples=[0.01]
    )
    keeps_connectivity: bool = Field(description="Whether the vertices and triangles of the scan come back.")
    model: str | None = Field(
        default=None,
        description="The dictionary that it was encoded with, as that was called then; null: the file holds it.",
        examples=["general-dictionary@1"],
    )
    model_sha256: str | None = Field(default=None, description="sha256 of that dictionary's file, in hex.")


class MeshFacts(Response):
    """What the analysis found. Of a `.qpz` file, whose header alone is read, null is what decoding would show."""

    format: Format = Field(description="Format that the file was read as.", examples=["ply"])
    unit: str | None = Field(
        default=None, description="Length unit that the file states; null: it states none.", examples=["millimeter"]
    )
    vertices: int | None = Field(default=None, ge=0, description="Vertices in the file.", examples=[85_182])
    triangles: int | None = Field(default=None, ge=0, description="Triangles, polygons cut.", examples=[168_702])
    bounding_box: BoundingBox | None = Field(default=None, description="Box around all vertices.")
    diagonal: float | None = Field(
        default=None, ge=0, description="Diagonal of the bounding box, in mesh units.", examples=[3.46]
    )
    mean_edge_length: float | None = Field(
        default=None, ge=0, description="Mean length of an edge, in mesh units.", examples=[0.02]
    )
    encoded: EncodedFacts | None = Field(default=None, description="What a `.qpz` file says of itself; else null.")
    bridges: list[FacingLoops] = Field(
        default_factory=list, description="Proposals: pairs of loops that `holes.bridges` of a job could join."
    )
    holes: list[Hole] = Field(description="Boundary loops, widest first.")
    warnings: list[str] = Field(
        default_factory=list, description="What the file holds more than once, or the wrong way round, for people."
    )
    warning_details: WarningDetails = Field(default_factory=list)


class MeshProblem(Response):
    """Why a mesh was rejected."""

    code: FailureCode
    message: str = Field(description="A sentence for people.", examples=["the header promises 10 vertices, 3 follow"])


class MeshLinks(Response):
    """Paths on this service."""

    self: str = Field(description="This mesh.")
    content: str = Field(description="Its bytes, as uploaded.")


class _Upload(Response):
    """What lists and the mesh itself say of an upload."""

    id: MeshId
    state: MeshState = Field(description="Whether a worker has analysed the file.", examples=["ready"])
    filename: str | None = Field(
        default=None, description="As the sender of its latest upload named it.", examples=["face000.ply"]
    )
    format: Format | None = Field(default=None, description="As stated or seen; null: unknown.", examples=["ply"])
    size_bytes: int = Field(ge=0, description="Size of the file, in bytes.", examples=[3_212_000])
    created_at: Moment = Field(description="When it was first uploaded, RFC 3339.")
    pinned: bool = Field(default=False, description="Whether it is kept whatever the retention.")
    expires_at: Moment | None = Field(
        default=None, description="When it is removed, RFC 3339; null: a job on it is there, or it is kept."
    )
    links: MeshLinks = Field(description="Paths on this service.")


class Mesh(_Upload):
    """An uploaded mesh."""

    facts: MeshFacts | None = Field(default=None, description="Set once the state is `ready`.")
    problem: MeshProblem | None = Field(default=None, description="Set once the state is `rejected`.")


class MeshSummary(_Upload):
    """An uploaded mesh, as lists have it."""

    triangles: int | None = Field(default=None, ge=0, description="Once it is analysed.", examples=[166_259])
    holes: int | None = Field(default=None, ge=0, description="Boundary loops, once it is analysed.", examples=[39])

    @classmethod
    def of(cls, mesh: Mesh) -> Self:
        """Sum a mesh up."""
        values = {name: getattr(mesh, name) for name in _Upload.model_fields}
        facts = mesh.facts
        counts = {} if facts is None else {"triangles": facts.triangles, "holes": len(facts.holes)}
        return cls.model_validate(values | counts)


class MeshPage(Response):
    """One page of meshes."""

    items: list[MeshSummary] = Field(description="Newest first.")
    next_cursor: str | None = Field(default=None, description="Pass as `cursor` to go on; null on the last page.")
