"""What a job does with its mesh besides filling holes: options by task. Lengths are in mesh units."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from quadpatch_client.schema.base import WHOLE, MeshId, Request
from quadpatch_rules.option_words import RestorationBase

VertexIndex = Annotated[int, Field(ge=0, le=2**31 - 1), WHOLE]
VertexIndices = Annotated[list[VertexIndex], Field(min_length=1, max_length=100_000)]
PropertyName = Annotated[str, Field(pattern=r"^[\x21-\x7e]{1,64}$")]
Coordinate = Annotated[float, Field(ge=-1e18, le=1e18)]
Corner = Annotated[list[Coordinate], Field(min_length=3, max_length=3)]


class MissingAsNan(Request):
    """Missing are the vertices whose three coordinates are NaN."""

    kind: Literal["nan"] = Field(description="Their coordinates are NaN.", examples=["nan"])


class MissingByProperty(Request):
    """Missing are the vertices that a vertex property of a PLY file marks."""

    kind: Literal["property"] = Field(description="A property marks them.", examples=["property"])
    name: PropertyName = Field(
        description="Name of the property; a vertex is missing where it is not 0.", examples=["missing"]
    )


class MissingByIndex(Request):
    """Missing are the vertices of a list."""

    kind: Literal["indices"] = Field(description="A list names them.", examples=["indices"])
    indices: VertexIndices = Field(description="Numbers of vertices in the file, from 0.", examples=[[7, 19, 20]])


Missing = Annotated[MissingAsNan | MissingByProperty | MissingByIndex, Field(discriminator="kind")]


class Restoring(Request):
    """Options of the task `restore`."""

    missing: Missing = Field(
        description="Which vertices get a position; all others keep their bits.", examples=[{"kind": "nan"}]
    )
    base: RestorationBase = Field(
        default="mesh",
        description="What says where they lie: `mesh`, the triangles around them; `poisson`, a screened Poisson "
        "surface of the measured vertices is tried as well, which takes longer.",
        examples=["mesh"],
    )


class RegionBox(Request):
    """The vertices in a box along the axes, in mesh units; its sides belong to it."""

    kind: Literal["box"] = Field(description="A box.", examples=["box"])
    min: Corner = Field(description="Smallest coordinates.", examples=[[-1.0, -1.0, 0.0]])
    max: Corner = Field(description="Largest coordinates.", examples=[[1.0, 1.0, 2.0]])

    @model_validator(mode="after")
    def _is_a_box(self) -> Self:
        if any(low > high for low, high in zip(self.min, self.max, strict=True)):
            raise ValueError("min lies above max along an axis")
        return self


class RegionByProperty(Request):
    """The vertices that a vertex property of a PLY file marks."""

    kind: Literal["property"] = Field(description="A property marks them.", examples=["property"])
    name: PropertyName = Field(
        description="Name of the property; a vertex belongs to the region where it is not 0.", examples=["rough"]
    )


Region = Annotated[RegionBox | RegionByProperty, Field(discriminator="kind")]


class Denoising(Request):
    """Options of the task `denoise`."""

    noise: float | None = Field(
        default=None,
        gt=0,
        le=1e12,
        description="Standard deviation of the noise along the normal, in mesh units; null: estimated.",
        examples=[0.05],
    )
    max_shift: float | None = Field(
        default=None,
        gt=0,
        le=1e12,
        description="No vertex is moved farther than this, in mesh units; null: a bound that follows from the noise.",
        examples=[0.2],
    )
    region: Region | None = Field(
        default=None,
        description="Vertices outside of it stay; null: all may move.",
        examples=[{"kind": "box", "min": [-1.0, -1.0, 0.0], "max": [1.0, 1.0, 2.0]}],
    )
    reference: MeshId | None = Field(
        default=None,
        description="Id of a clean scan of a similar object, uploaded like any mesh: the dictionary is learned from "
        "it. It is kept as long as the job is. Goes with the model `self`.",
    )


class Encoding(Request):
    """Options of the task `encode`."""

    max_error: float = Field(
        gt=0,
        le=1e12,
        description="How far the decoded surface may lie from the scan's at most, in mesh units.",
        examples=[0.01],
    )
    keep_connectivity: bool = Field(
        default=False,
        description="Whether to store the triangles as well, so that decoding brings every vertex back in its order; "
        "else the surface comes back as a regular mesh.",
    )
