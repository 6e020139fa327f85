"""What a job is asked to do. `{"mesh_id": …}` alone is a whole job."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from jobkit.schema.base import REFERENCE_PATTERN, TEXT_PATTERN, WHOLE, MeshId, Request
from shared_rules.hole_selection import MODEL_FILLS_ONLY, Cap, HoleKind, RuleAction, names_fills

Format = Literal["ply", "stl", "obj", "off", "glb", "gltf", "3mf"]
OutputFormat = Literal["ply", "stl", "obj", "off", "glb", "3mf"]
DEFAULT_MODEL = "default"
DEFAULT_NETWORK = "default-network"
SELF = "self"
Recipe = Literal["default", "paper"]

Resolution = Annotated[int, Field(ge=8, le=128), WHOLE]
Overlap = Annotated[int, Field(ge=0, le=8), WHOLE]
HoleId = Annotated[int, Field(ge=0, le=2**31 - 1), WHOLE]
FittingSteps = Annotated[int, Field(ge=1, le=100_000), WHOLE]
MemoryMb = Annotated[int, Field(ge=256, le=1_048_576), WHOLE]
Seed = Annotated[int, Field(ge=0, le=2**32 - 1), WHOLE]
Text = Annotated[str, Field(max_length=200, pattern=TEXT_PATTERN)]
FileName = Annotated[str, Field(min_length=1, max_length=255, pattern=TEXT_PATTERN)]
_METADATA_KEY = r"^[A-Za-z0-9_.-]{1,64}$"
MetadataKey = Annotated[str, Field(pattern=_METADATA_KEY)]


def _name_property_pattern(schema: dict[str, Any]) -> None:
    """Say that other keys are refused; patternProperties alone would let them pass."""
    ((_, values),) = schema.pop("patternProperties").items()
    schema.update(propertyNames={"pattern": _METADATA_KEY}, additionalProperties=values)


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
        "follows. `paper` needs `self` or a dictionary learned for it.",
        examples=["default"],
    )
    patches: PatchOptions = Field(default_factory=PatchOptions, description="How patches are laid out.")


class Fitting(Request):
    """How long a network is fitted to the mesh itself; goes with the model `self` alone."""

    steps: FittingSteps = Field(default=1000, description="At most so many steps, of 64 patches each.", examples=[1000])
    seconds: float = Field(
        default=600.0,
        gt=0,
        le=86_400,
        description="At most so long, and at most two thirds of the job's time limit. Where this ends before the steps "
        "do, another run may give other bytes.",
        examples=[300.0],
    )


class CnnMethod(Request):
    """A convolutional network."""

    method: Literal["cnn"] = Field(description="A convolutional network.", examples=["cnn"])
    model: str = Field(
        default=DEFAULT_NETWORK,
        pattern=REFERENCE_PATTERN,
        description="`name@version`, `name` (its latest version), an alias, or `self`: fit the shipped network to the "
        "undamaged part of the uploaded mesh, which takes minutes.",
        examples=["self"],
    )
    fitting: Fitting = Field(
        default_factory=Fitting, description="How long `self` may take; refused with any other model."
    )
    patches: PatchOptions = Field(default_factory=PatchOptions, description="How patches are laid out.")


class SmoothMethod(Request):
    """No learned model: triangulate, refine and fair every hole (thin plate)."""

    method: Literal["smooth"] = Field(description="Thin-plate fill without a model.", examples=["smooth"])


Method = Annotated[DictionaryMethod | CnnMethod | SmoothMethod, Field(discriminator="method")]


HoleIds = Annotated[list[HoleId], Field(min_length=1, max_length=100_000)]


class HoleRule(Request):
    """What to do with the holes that meet all of some conditions; one without conditions is about every hole.

    A rule that names neither `ids` nor a `kind` passes by the borders and open ends that no other option asks for.
    """

    action: RuleAction = Field(
        description="`skip` leaves them open. `model`: as `method` says. `smooth`: by geometry alone. `flat`: by a "
        "plane patch.",
        examples=["flat"],
    )
    ids: HoleIds | None = Field(default=None, description="These holes.", examples=[[0, 3]])
    kind: HoleKind | None = Field(default=None, description="Holes of this kind.", examples=["open_end"])
    min_diameter: float | None = Field(
        default=None, gt=0, le=1e12, description="As wide or wider, in mesh units.", examples=[5.0]
    )
    max_diameter: float | None = Field(
        default=None, gt=0, le=1e12, description="As wide or narrower, in mesh units.", examples=[25.0]
    )
    max_perimeter: float | None = Field(
        default=None, gt=0, le=1e12, description="With a rim as long or shorter, in mesh units.", examples=[80.0]
    )


class HoleSelection(Request):
    """Which holes to fill, and how.

    By default every hole and slit is filled, outer borders of pieces and open ends stay open, and so do holes wider
    than a quarter of the scan's diagonal. What is given adds up: `ids` with `max_diameter` means those of the ids that
    are no wider.
    """

    max_diameter: float | None = Field(
        default=None, gt=0, le=1e12, description="Leave wider holes open, in mesh units.", examples=[25.0]
    )
    max_perimeter: float | None = Field(
        default=None, gt=0, le=1e12, description="Leave holes with a longer rim open, in mesh units.", examples=[80.0]
    )
    all_but_largest: bool = Field(default=False, description="Leave the widest loop open: the border of an open scan.")
    ids: list[HoleId] | None = Field(
        default=None,
        min_length=1,
        max_length=100_000,
        description="Just these holes, by the ids of the mesh's hole list; borders and open ends among them.",
        examples=[[0, 3, 4]],
    )
    include_borders: bool = Field(
        default=False, description="Treat outer borders of pieces like holes; else they stay open, whatever their size."
    )
    cap: Cap | None = Field(
        default=None,
        description="`flat`: close open ends (of tubes, of cut-off bases) by a plane patch; null: leave them open.",
        examples=["flat"],
    )
    rules: list[HoleRule] = Field(
        default_factory=list,
        max_length=32,
        description="The first rule whose conditions a hole meets says what is done with it.",
        examples=[[{"kind": "open_end", "action": "flat"}, {"max_diameter": 5.0, "action": "smooth"}]],
    )


Tolerance = Annotated[float, Field(ge=0, le=1e12)] | Literal["auto"]


class Output(Request):
    """What the job hands back."""

    format: OutputFormat | None = Field(
        default=None, description="Format of the repaired mesh; null: that of the upload.", examples=["ply"]
    )
    preview: bool = Field(default=True, description="Whether to draw a before/after picture.")
    closeups: bool = Field(
        default=False,
        description="Whether to draw each chosen hole before and after: a ZIP file of `hole_<id>.png`, at most 100 of "
        "them, the widest.",
    )


class Limits(Request):
    """Ceilings of one attempt, at most those of the service. Null: those of the service."""

    time_s: float | None = Field(default=None, ge=1, le=86_400, description="Wall-clock seconds.", examples=[120.0])
    memory_mb: MemoryMb | None = Field(default=None, description="Memory of the engine, in MiB.", examples=[2048])


def default_method() -> DictionaryMethod:
    """Return the method of a job that names none."""
    return DictionaryMethod(method="dictionary")


class RepairSpec(Request):
    """What to do with a mesh."""

    method: Method = Field(default_factory=default_method, description="How holes are filled.")
    holes: HoleSelection = Field(default_factory=HoleSelection, description="Which holes are filled.")
    weld_tolerance: Tolerance = Field(
        default="auto",
        description="How far apart boundary vertices are taken for one, in mesh units: 0 joins equal positions alone, "
        "`auto` what rounding in the file accounts for. Ids of holes are those found with `auto`, so that `holes.ids` "
        "is refused with any other tolerance.",
        examples=["auto", 0.001],
    )
    output: Output = Field(default_factory=Output, description="What is handed back.")
    limits: Limits = Field(default_factory=Limits, description="Ceilings of one attempt.")
    seed: Seed = Field(default=0, description="Starts every random choice.", examples=[0])
    label: Text | None = Field(default=None, description="A name for people.", examples=["station 4, part 1187"])
    metadata: dict[MetadataKey, Text] = Field(
        default_factory=dict,
        max_length=16,
        description="Up to 16 facts of the sender's own, handed back unread.",
        json_schema_extra=_name_property_pattern,
        examples=[{"order": "A-17"}],
    )

    @model_validator(mode="after")
    def _ids_need_the_known_holes(self) -> Self:
        if self.weld_tolerance != "auto" and self.holes.ids is not None:
            raise ValueError("holes.ids names holes found with the weld_tolerance auto: drop one of the two")
        return self


def conflict_of(spec: RepairSpec) -> str | None:
    """Say in a sentence which options of a job exclude each other; None where none do.

    It is asked where a job is made, and not part of reading a spec: jobs that were stored before a rule came up are
    still read.
    """
    if spec.weld_tolerance != "auto" and any(rule.ids is not None for rule in spec.holes.rules):
        return "ids of holes.rules name holes found with the weld_tolerance auto: drop one of the two"
    is_paper = isinstance(spec.method, DictionaryMethod) and spec.method.recipe == "paper"
    if is_paper and names_fills(spec.holes):
        return MODEL_FILLS_ONLY
    return None


class JobSpec(RepairSpec):
    """A whole job: a mesh, and what to do with it."""

    mesh_id: MeshId
    mesh_name: FileName | None = Field(
        default=None,
        description="Name of the mesh's file, after which the result is named; null: that of its latest upload. The "
        "same bytes may come as several files.",
        examples=["face000.ply"],
    )
