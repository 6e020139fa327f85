"""Views of meshes, jobs and models.

Tested in `tests/service/routes/test_views.py`.
"""

from typing import Annotated, Literal

from pydantic import Field

from quadpatch_client.schema.base import Response

ViewLevel = Literal["coarse", "fine"]
_Point = Annotated[list[float], Field(min_length=3, max_length=3)]


class ViewState(Response):
    """That a view is being made: ask again, or send `Prefer: wait=10`."""

    state: Literal["making"] = Field(description="The view is not there yet.", examples=["making"])


class Outline(Response):
    """The rim of one hole. Lengths are in mesh units."""

    id: int = Field(ge=0, description="Of the hole, as the analysis counts.", examples=[3])
    kind: str = Field(description="What kind of hole, as the analysis tells.", examples=["hole"])
    diameter: float = Field(description="Largest distance between two vertices of the rim.", examples=[6.1])
    perimeter: float = Field(description="Length of the rim.", examples=[19.2])
    centre: _Point = Field(description="Mean of the rim, in coordinates of the mesh.", examples=[[10.0, 2.5, 0.0]])
    normal: _Point = Field(description="Unit vector that the hole faces.", examples=[[0.0, 0.0, 1.0]])
    rim: list[_Point] = Field(
        description="Corners of a closed polyline, relative to the origin.",
        examples=[[[9.0, 2.5, 0.0], [11.0, 1.5, 0.0], [11.0, 3.5, 0.0]]],
    )
    is_thinned: bool = Field(description="Whether vertices of the rim were left out.", examples=[False])


class Outlines(Response):
    """The rims of a mesh's holes."""

    origin: _Point = Field(description="What rims are relative to, in coordinates of the mesh.", examples=[[1, 0, 0]])
    length_unit: str = Field(
        description="Unit of all lengths; `mesh units` where the file states none.", examples=["millimeter"]
    )
    n_holes: int = Field(ge=0, description="How many holes there are.", examples=[1])
    holes: list[Outline] = Field(description="The widest first, at most 10,000.")
