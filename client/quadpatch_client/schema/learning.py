"""What a training learns, and what came of it: the parts of a job of the task `train`.

Tested in `tests/service/routes/test_trainings.py`.
"""

from typing import Annotated, Literal

from pydantic import Field

from quadpatch_client.schema.base import WHOLE, AliasName, MeshId, ModelName, Request, Response, Sha256

MOST_MESHES = 200
Atoms = Annotated[int, Field(ge=8, le=1024), WHOLE]
PatchResolution = Annotated[int, Field(ge=8, le=32), WHOLE]
Steps = Annotated[int, Field(ge=1, le=100), WHOLE]
FittingSteps = Annotated[int, Field(ge=1, le=20_000), WHOLE]
TrainedKind = Literal["dictionary", "network"]
MakeDefault = Literal["never", "if_better"]


HeldOut = Annotated[
    float,
    Field(
        gt=0,
        le=0.5,
        description="Share of the meshes that are kept from learning and judged on: at least one, at most eight. Of a "
        "single mesh, holes that are cut into it are kept instead.",
        examples=[0.25],
    ),
]


class TrainingOptions(Request):
    """How a dictionary is learned."""

    atoms: Atoms = Field(default=256, description="Atoms of the dictionary.", examples=[256])
    patch_resolution: PatchResolution = Field(default=24, description="Bins along one side of a patch.", examples=[24])
    steps: Steps = Field(default=15, description="Rounds of K-SVD.", examples=[15])
    held_out: HeldOut = 0.25


class NetworkTrainingOptions(Request):
    """How a network is fitted."""

    steps: FittingSteps = Field(
        default=500,
        description="At most so many steps, of 64 training pairs each; fewer where nothing is gained any more.",
        examples=[500],
    )
    start: Literal["shipped", "random"] = Field(
        default="shipped",
        description="Weights to begin with: those of the network that ships, `general-residual@1`, or random ones, "
        "which need thousands of steps.",
        examples=["shipped"],
    )
    held_out: HeldOut = 0.25


class TrainingSpec(Request):
    """Options of the task `train`."""

    model: ModelName
    kind: TrainedKind = Field(default="dictionary", description="What is learned.", examples=["network"])
    meshes: list[MeshId] = Field(
        min_length=1, max_length=MOST_MESHES, description="Ids of the meshes that it learns from and is judged on."
    )
    options: TrainingOptions = Field(default_factory=TrainingOptions, description="Of a dictionary: how it is learned.")
    network: NetworkTrainingOptions = Field(
        default_factory=NetworkTrainingOptions, description="Of a network: how it is fitted."
    )
    make_default: MakeDefault = Field(
        default="never",
        description="`if_better`: the alias is pointed to the new version where held-out meshes say that it is better "
        "than the plain fill.",
        examples=["if_better"],
    )
    alias: AliasName = Field(default="default")


class JudgedMesh(Response):
    """What a model does to known holes of a mesh that nothing was learned from. Lengths are in mesh units."""

    mesh_id: MeshId
    kept: Literal["mesh", "holes"] = Field(
        description="What was kept from learning: the whole mesh, or only the surface of its holes.", examples=["mesh"]
    )
    holes: int = Field(ge=1, description="Holes that were cut into it.", examples=[12])
    error: float = Field(ge=0, description="Mean distance from the true surface, repaired by the model.")
    plain_error: float = Field(ge=0, description="The same of the plain fill, `smooth`.")
    ratio: float = Field(ge=0, description="The first divided by the second; below 1 the model is better.")


class TrainingResult(Response):
    """What a training has learned."""

    model: ModelName
    version: int = Field(ge=1, description="The version that holds it.", examples=[1])
    is_new: bool = Field(description="False: an earlier training has learned the very same bytes.")
    sha256: Sha256
    learned_from: list[MeshId] = Field(description="Meshes that it was learned from.")
    kind: TrainedKind = Field(default="dictionary", description="What it is.", examples=["dictionary"])
    patches: int = Field(
        ge=0, description="Patches, or training pairs of a network, that it was learned from.", examples=[12_000]
    )
    judged: list[JudgedMesh] = Field(description="Errors beside the plain fill, for each mesh that was held out.")
    is_better: bool = Field(description="Whether it is better than the plain fill, all in all.")
    verdict: str = Field(
        description="A sentence for people.",
        examples=["worse than the plain fill on 3 of 4 meshes: not made default"],
    )
    alias: AliasName | None = Field(default=None, description="The alias that was pointed to it; null: none was.")
