"""How a job puts patches to use: the methods, their models and options.

Tested in `tests/quadpatch_client/schema/test_spec.py`.
"""

from typing import Annotated, Literal

from pydantic import Field

from quadpatch_client.schema.base import REFERENCE_PATTERN, WHOLE, MeshId, Request
from quadpatch_rules.option_words import Effort, Preset, Recipe

DEFAULT_MODEL = "default"
DEFAULT_NETWORK = "default-network"
# What the two mean with the recipe `paper`.
DEFAULT_PAPER_MODEL = "default-paper"
DEFAULT_PAPER_NETWORK = "default-paper-network"
SELF = "self"

Resolution = Annotated[int, Field(ge=8, le=128), WHOLE]
Overlap = Annotated[int, Field(ge=0, le=8), WHOLE]
Atoms = Annotated[int, Field(ge=2, le=4096), WHOLE]
Nonzero = Annotated[int, Field(ge=1, le=256), WHOLE]
FittingSteps = Annotated[int, Field(ge=1, le=100_000), WHOLE]


class PatchOptions(Request):
    """How patches are laid out. Null means: chosen from the mesh's edge length and the sizes of its holes."""

    length: float | None = Field(
        default=None, gt=0, le=1e12, description="Side of a patch, in mesh units.", examples=[4.5]
    )
    resolution: Resolution | None = Field(default=None, description="Bins along one side of a patch.", examples=[24])
    overlap: Overlap | None = Field(
        default=None,
        description="k of the paper: every quad carries its centre patch and 4 k offset ones.",
        examples=[2],
    )
    preset: Preset | None = Field(
        default=None,
        description="The paper's two kinds of patches, in place of a length and a resolution: `type1` has 0.03 of the "
        "mesh's longest side and 16 bins, `type2` 0.06 and 24.",
        examples=["type2"],
    )


class DictionarySize(Request):
    """How large a dictionary the recipe `paper` learns from the mesh itself. Null means: chosen by the method."""

    atoms: Atoms | None = Field(default=None, description="At most so many atoms.", examples=[100])
    nonzero: Nonzero | None = Field(default=None, description="Atoms that one patch may use.", examples=[10])


class DictionaryMethod(Request):
    """Sparse coding over a dictionary of patches."""

    method: Literal["dictionary"] = Field(description="Sparse coding over a dictionary.", examples=["dictionary"])
    model: str = Field(
        default=DEFAULT_MODEL,
        pattern=REFERENCE_PATTERN,
        description="`name@version`, `name` (its latest version), an alias, or `self`: learn a dictionary from the "
        "undamaged part of the uploaded mesh.",
        examples=["self"],
    )
    recipe: Recipe = Field(
        default="default",
        description="How the dictionary is put to use: `default`, or `paper`, exactly as in the paper that the method "
        "follows. `paper` needs `self` or a dictionary learned for it; its default is `default-paper`.",
        examples=["default"],
    )
    learn_from: MeshId | None = Field(
        default=None,
        description="Another mesh, in the same unit of length, that `self` learns its dictionary from: one of the same "
        "kind that is whole, or less worn. Null: the mesh itself.",
    )
    dictionary: DictionarySize = Field(
        default_factory=DictionarySize,
        description="How large a dictionary `self` learns; refused with any other model, and with the recipe "
        "`default`, which finds out by itself.",
    )
    patches: PatchOptions = Field(default_factory=PatchOptions, description="How patches are laid out.")


class Fitting(Request):
    """How long a network is fitted to the mesh itself."""

    steps: FittingSteps = Field(
        default=800,
        description="At most so many steps, of 64 patches each; fewer where calibration holes gain nothing more.",
        examples=[800],
    )
    seconds: float | None = Field(
        default=None,
        gt=0,
        le=86_400,
        description="At most so long; null sets no limit but two thirds of the job's time limit. Where time ends the "
        "fitting, the report says so (`model.fitting`), and another run may give other bytes.",
        examples=[300.0],
    )


class CnnMethod(Request):
    """A convolutional network."""

    method: Literal["cnn"] = Field(description="A convolutional network.", examples=["cnn"])
    model: str = Field(
        default=DEFAULT_NETWORK,
        pattern=REFERENCE_PATTERN,
        description="`name@version`, `name` (its latest version), an alias, or `self`: fit the shipped network to the "
        "undamaged part of the uploaded mesh, which takes about a minute.",
        examples=["self"],
    )
    recipe: Recipe = Field(
        default="default",
        description="How the network is put to use: `default`, or `paper`, exactly as in the paper that the method "
        "follows. `paper` needs one of the paper's networks; its default is `default-paper-network`.",
        examples=["default"],
    )
    fitting: Fitting = Field(
        default_factory=Fitting, description="How long `self` may take; refused with any other model."
    )
    patches: PatchOptions = Field(default_factory=PatchOptions, description="How patches are laid out.")


class SmoothMethod(Request):
    """No learned model: triangulate, refine and fair every hole (thin plate)."""

    method: Literal["smooth"] = Field(description="Thin-plate fill without a model.", examples=["smooth"])


class AutoMethod(Request):
    """Models compete on holes cut for calibration; the best one, a mean of several or geometry alone fills the holes.

    The report says which were tried, and what came of it.
    """

    method: Literal["auto"] = Field(description="What calibration on the mesh finds best.", examples=["auto"])
    effort: Effort = Field(
        default="standard",
        description="What is tried: `fast` geometry alone, `standard` also a dictionary learned from the mesh itself "
        "and the network that ships (seconds), `best` also that network fitted to the mesh (a minute).",
        examples=["standard"],
    )
    fitting: Fitting = Field(
        default_factory=Fitting, description="How long the network is fitted; refused with another effort than `best`."
    )
    patches: PatchOptions = Field(default_factory=PatchOptions, description="How patches are laid out.")


Method = Annotated[DictionaryMethod | CnnMethod | SmoothMethod | AutoMethod, Field(discriminator="method")]
