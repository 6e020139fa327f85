"""The report of a repair, as `GET /v1/jobs/{job_id}/report` hands it out.

The method writes it (`quadpatch.report`); these models describe it to clients. Lengths are in the unit that
`length_unit` names; a number that is not finite is null.

Tested in `tests/quadpatch_client/schema/test_reports.py`.
"""

from typing import Annotated, Any, Literal

from pydantic import Field

from quadpatch_client.schema.acceptance import Accepted
from quadpatch_client.schema.base import Response
from quadpatch_client.schema.jobs import HoleCounts
from quadpatch_client.schema.report_parts import AppliedPatches, Box, SourceMesh, TaskReport, Vector, Welded
from quadpatch_client.schema.task_reports import DecodeReport, DenoiseReport, EncodeReport, RestoreReport
from quadpatch_client.schema.training_reports import TrainReport
from quadpatch_rules.hole_selection import HoleKind

HoleVerdict = Literal["filled", "filled_smooth", "skipped", "refused"]


class EnergyShare(Response):
    """An energy whose minimum is part of a fill."""

    membrane: float = Field(description="Weight of the area.", examples=[0.0])
    plate: float = Field(description="Weight of the bending.", examples=[1.0])
    variation: float = Field(description="Weight of the variation of the bending.", examples=[0.0])
    slope: float = Field(description="How much steeper than the measured rim the fill leaves it.", examples=[1.0])
    share: float = Field(description="Its share of the fill.", examples=[0.5])


class BridgeReport(Response):
    """A bridge between two loops."""

    holes: list[int] = Field(description="Ids of both.", examples=[[3, 17]])
    shape: Literal["ring", "strip"] = Field(description="What lies between the rims.", examples=["ring"])
    gap: float = Field(description="Mean distance between the rims, in mesh units.", examples=[0.8])


class HoleReport(Response):
    """A hole: where it is, what was done with it, by what, and how sure that is."""

    id: int = Field(ge=0, description="Counts the holes of this repair from 0, widest first.", examples=[0])
    edges: int = Field(ge=0, description="Edges of its rim.", examples=[26])
    perimeter: float = Field(description="Length of its rim, in mesh units.", examples=[2.01])
    diameter: float = Field(description="Largest distance of two rim vertices, in mesh units.", examples=[0.52])
    area: float | None = Field(description="Area of the rim's mean plane within it, in square units.", examples=[0.156])
    planarity: float | None = Field(
        description="RMS distance of the rim to its mean plane, as a share of the diameter.", examples=[0.012]
    )
    is_manifold: bool = Field(description="Whether its rim passes through each vertex once.", examples=[True])
    is_border: bool = Field(description="Whether it is the outer border of an open scan.", examples=[False])
    kind: HoleKind = Field(description="What the loop looks like.", examples=["hole"])
    centre: Vector = Field(description="Mean of the rim vertices, in mesh units.", examples=[[0.99, 0.0, 0.0]])
    normal: Vector = Field(description="Unit normal of the rim's mean plane.", examples=[[1.0, 0.0, 0.0]])
    bounding_box: Box = Field(description="Box around its rim.")
    verdict: HoleVerdict = Field(
        description="`filled` with the model, `filled_smooth` by geometry alone, `skipped` by rule, `refused` because "
        "it can't be filled well.",
        examples=["filled"],
    )
    code: str | None = Field(description="Why, as a stable code; null where it was filled.", examples=["no_gain"])
    reason: str | None = Field(description="The same for people.", examples=["no learned model took part"])
    confidence: float | None = Field(
        description="From 0 to 1; falls with the expected error in relation to the scan's diagonal. Null where there "
        "is no measure of it.",
        examples=[0.95],
    )
    expected_error: float | None = Field(
        description="Expected mean distance of the fill to the true surface, in mesh units; null like `confidence`.",
        examples=[0.00054],
    )
    fill: str | None = Field(
        description="Which geometric fill carries it: `energies`, `creases`, `flat`, `thin_plate`, `constrained`.",
        examples=["energies"],
    )
    energies: list[EnergyShare] | None = Field(
        description="The energies of the fills `energies` and `creases`; else null."
    )
    new_vertices: int = Field(ge=0, description="Vertices that were added.", examples=[50])
    new_triangles: int = Field(ge=0, description="Triangles that were added.", examples=[124])
    measures: dict[str, float | None] = Field(
        description="What the verdict rests on, with the `folds` and `crossings` that the check of the result left.",
        examples=[{"gap": 1.2e-05, "rim_turn": 0.069, "folds": 0.0, "crossings": 0.0}],
    )
    bridge: BridgeReport | None = Field(description="The bridge that joins this loop to another; else null.")
    hole_id: int | None = Field(
        default=None,
        description="Its number in the repaired file; null where it was not filled, or the format has no numbers.",
        examples=[0],
    )


class CalibrationReport(Response):
    """The holes that were cut into the scan itself to find out what fills it best."""

    holes: int = Field(ge=0, description="How many; 0 where there was no room for any.", examples=[24])
    reused: bool = Field(description="Whether an earlier repair of the same scan has cut and filled them.")
    seconds: float = Field(ge=0, description="Seconds that they took, now or then.", examples=[2.1])


class PaintReport(Response):
    """How colours were carried on."""

    method: Literal["exemplars", "harmonic"] | None = Field(
        description="Carried on from the surroundings, or spread from the rim; null where nothing was painted.",
        examples=["exemplars"],
    )
    calibration: dict[str, Any] | None = Field(
        description="What `exemplars` did on calibration holes beside `harmonic`: `gain_db` (PSNR), `kept` and "
        "`kept_harmonic` (gradient energy over the truth's), `n_holes`; null where it was not tried.",
        examples=[{"gain_db": -0.4, "kept": 0.73, "kept_harmonic": 0.41, "n_holes": 12}],
    )


class PageSize(Response):
    """A texture page for the new triangles."""

    width: int = Field(ge=1, description="In texels.", examples=[512])
    height: int = Field(ge=1, description="In texels.", examples=[256])
    charts: int = Field(ge=1, description="Pieces of surface on it.", examples=[14])


class ImageProblem(Response):
    """An image that was needed and not carried on."""

    image: str = Field(description="Which.", examples=["scan.png"])
    code: str = Field(description="Stable code.", examples=["image_missing"])
    message: str = Field(description="A sentence for people.", examples=["the file is not there"])


class TextureReport(PaintReport):
    """How the texture was carried on."""

    page: PageSize | None = Field(description="The page for the new triangles; null where none was made.")
    problems: list[ImageProblem] = Field(description="Images that were needed and not carried on.")


class FillReport(TaskReport):
    """The report of a repair: what was found, filled and left open, hole by hole, and why."""

    task: Literal["fill"] = Field(description="What was done.", examples=["fill"])
    source: SourceMesh = Field(description="The mesh that came in.")
    welded: Welded = Field(description="How its triangles became one surface.")
    counts: HoleCounts = Field(description="Verdicts over all holes.")
    patches: AppliedPatches | None = Field(description="The patches of the model; null without one.")
    calibration: CalibrationReport | None = Field(
        default=None, description="The calibration holes; null with the recipe `paper`."
    )
    holes: list[HoleReport] = Field(description="All holes, widest first.")
    colours: PaintReport | None = Field(
        default=None, description="Colours of vertices; null where the mesh has none, or nothing is new."
    )
    acceptance: Accepted | None = Field(
        default=None, description="What came of the limits of the spec; null where it has none."
    )
    texture: TextureReport | None = Field(
        default=None, description="Texture images; null where the mesh has none, or nothing is new."
    )


Report = Annotated[
    FillReport | RestoreReport | DenoiseReport | EncodeReport | DecodeReport | TrainReport, Field(discriminator="task")
]
