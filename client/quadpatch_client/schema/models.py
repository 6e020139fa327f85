"""Models, their versions and aliases as clients see them.

Tested in `tests/jobkit/models/test_header.py`.
"""

from typing import Annotated, Any, Literal

from pydantic import Field

from quadpatch_client.schema.base import (
    TEXT_PATTERN,
    AliasName,
    ModelName,
    ModelReference,
    Moment,
    Request,
    Response,
    Sha256,
)
from quadpatch_client.schema.codes import FailureCode
from quadpatch_client.schema.states import ModelState

ModelKind = Literal["dictionary", "autoencoder"]
ShortText = Annotated[str, Field(max_length=2000)]


class ModelCard(Response):
    """What is known about a model version; stated by those who trained it."""

    description: ShortText = Field(default="", description="One paragraph for people.", examples=["256 atoms …"])
    patch_resolution: int | None = Field(
        default=None, ge=1, description="Bins along one side of a patch.", examples=[24]
    )
    n_atoms: int | None = Field(default=None, ge=1, description="Atoms of a dictionary.", examples=[256])
    n_nonzero: int | None = Field(default=None, ge=1, description="Atoms that one patch may use.", examples=[12])
    length_rule: ShortText = Field(
        default="", description="How the patch length follows from the mesh.", examples=["auto"]
    )
    normalisation: ShortText = Field(default="", description="What is taken from a patch before coding.")
    corpus_sha256: str | None = Field(
        default=None, max_length=64, description="sha256 over the training corpus, in hex."
    )
    metrics: dict[str, float] = Field(
        default_factory=dict, description="Measures on held-out meshes.", examples=[{"error_to_smooth": 0.97}]
    )
    licence: ShortText = Field(default="", description="SPDX id.", examples=["GPL-3.0-or-later"])
    intended_use: ShortText = Field(default="", description="What the model is for, and what it is not for.")
    extra: dict[str, Any] = Field(
        default_factory=dict, description="Further facts of the card, unread by the service.", examples=[{"seed": 0}]
    )


class ModelLinks(Response):
    """Paths on this service."""

    self: str = Field(description="This version.", examples=["/v1/models/general-dictionary/versions/1"])
    artifact: str = Field(description="Its bytes.", examples=["/v1/models/general-dictionary/versions/1/artifact"])


class ModelProblem(Response):
    """Why a model version was refused."""

    code: FailureCode
    message: str = Field(
        description="A sentence for people, which says which check failed.",
        examples=["copy@1 answers 1 patches by values that are not finite"],
    )


class Deprecation(Response):
    """That a model version should be used no more."""

    at: Moment = Field(description="Since when, RFC 3339.")
    reason: str = Field(default="", description="A sentence for people.", examples=["parts@2 closes thin ribs better"])


class DeprecationReason(Request):
    """Why a model version should be used no more."""

    reason: str = Field(
        default="",
        max_length=500,
        pattern=TEXT_PATTERN,
        description="A sentence for people.",
        examples=["parts@2 closes thin ribs better"],
    )


class ModelVersion(Response):
    """One immutable version of a model."""

    name: ModelName
    version: int = Field(ge=1, description="Counts up from 1.", examples=[1])
    kind: ModelKind = Field(description="A patch dictionary, or a denoising autoencoder.", examples=["dictionary"])
    sha256: Sha256
    size_bytes: int = Field(ge=0, description="Size of the artifact, in bytes.", examples=[1_180_208])
    format: Literal["safetensors", "onnx"] = Field(description="Format of the artifact.", examples=["safetensors"])
    card: ModelCard = Field(description="What is known about it.")
    state: ModelState = Field(
        default=ModelState.READY,
        description="`proving`: a worker is yet to open it; `ready`: jobs and aliases may use it; `refused`: they may "
        "not, `problem` says why.",
        examples=["ready"],
    )
    problem: ModelProblem | None = Field(default=None, description="Set once the state is `refused`.")
    deprecated: Deprecation | None = Field(default=None, description="Set where it should be used no more.")
    aliases: list[AliasName] = Field(default_factory=list, description="Aliases that point here.")
    shared: bool = Field(default=False, description="Whether all tenants see it; else it is yours alone.")
    created_at: Moment = Field(description="When it was published, RFC 3339.")
    links: ModelLinks = Field(description="Paths on this service.")


class Model(Response):
    """A model with all its versions."""

    name: ModelName
    latest: int = Field(
        ge=1,
        description="The version that the name alone means: the highest that is ready and not deprecated.",
        examples=[2],
    )
    versions: list[ModelVersion] = Field(description="Newest first.")
    next_cursor: int | None = Field(
        default=None,
        description="Pass as `cursor` to `GET /v1/models/{name}` for older versions; null where there are none.",
        examples=[12],
    )


class Alias(Response):
    """A name that points to a model version."""

    alias: AliasName
    name: ModelName
    version: int = Field(ge=1, description="The version it points to.", examples=[1])
    shared: bool = Field(default=False, description="Whether all tenants see it; else it is yours alone.")
    updated_at: Moment = Field(description="When it was last moved, RFC 3339.")


class AliasTarget(Request):
    """Where an alias is to point."""

    model: ModelReference


class ModelList(Response):
    """One page of models."""

    models: list[Model] = Field(description="By name, each with its newest versions.")
    aliases: list[Alias] = Field(description="Aliases that point to the models of this page, by alias.")
    next_cursor: str | None = Field(
        default=None, description="Pass as `cursor` to go on; null on the last page.", examples=["general-residual"]
    )


class ResolvedModel(Response):
    """The model that a job is pinned to."""

    requested: str = Field(description="As the spec named it.", examples=["default"])
    kind: Literal["dictionary", "autoencoder", "self", "self_network", "auto", "none"] = Field(
        description="`self`: a dictionary learned from the mesh itself; `self_network`: a network fitted to it; "
        "`auto`: what calibration on the mesh finds best; `none`: a smooth fill uses no model.",
        examples=["dictionary"],
    )
    name: str | None = Field(default=None, description="Name of the version.", examples=["general-dictionary"])
    version: int | None = Field(default=None, description="Its number.", examples=[1])
    sha256: str | None = Field(default=None, description="sha256 of its artifact, in hex.")
    deprecated_at: Moment | None = Field(
        default=None, description="Since when it should be used no more, RFC 3339; null: it may be."
    )
