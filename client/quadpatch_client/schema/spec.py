"""What a job is asked to do. `{"mesh_id": …}` alone is a whole job."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from quadpatch_client.schema.acceptance import Acceptance
from quadpatch_client.schema.base import REFERENCE_PATTERN, TEXT_PATTERN, WHOLE, MeshId, Request
from quadpatch_client.schema.learning import TrainingSpec
from quadpatch_client.schema.methods import SELF, AutoMethod, DictionaryMethod, DictionarySize, Method
from quadpatch_client.schema.tasks import Denoising, Encoding, Restoring
from quadpatch_client.schema.webhook_url import WebhookUrl
from quadpatch_rules.hole_selection import Cap, HoleKind, RuleAction, repeated_loop
from quadpatch_rules.option_words import CarriedAttribute, Colours, LengthUnit, OutputFormat, Tint
from quadpatch_rules.tasks import FILL, Task

# `qpz` is what the task `encode` hands back and `decode` reads; it is a mesh that is no list of triangles.
Format = Literal["ply", "stl", "obj", "off", "glb", "gltf", "3mf", "qpz"]

HoleId = Annotated[int, Field(ge=0, le=2**31 - 1), WHOLE]
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


Metadata = Annotated[
    dict[MetadataKey, Text],
    Field(max_length=16, json_schema_extra=_name_property_pattern, examples=[{"order": "A-17"}]),
]
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


# Two different loops; which ones there are is for the mesh to say.
Bridge = Annotated[list[HoleId], Field(min_length=2, max_length=2)]


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
    bridges: list[Bridge] = Field(
        default_factory=list,
        max_length=1000,
        description="Pairs of loops, by their ids, that a strip of surface joins across the gap between them, whatever "
        "else is said of these loops; each loop is named once. The mesh's facts propose pairs (`bridges`).",
        examples=[[[3, 17]]],
    )

    @model_validator(mode="after")
    def _each_loop_has_one_bridge(self) -> Self:
        repeated = repeated_loop(self.bridges)
        if repeated is not None:
            raise ValueError(repeated)
        return self


Priority = Literal["interactive", "normal", "bulk"]
Tolerance = Annotated[float, Field(ge=0, le=1e12)] | Literal["auto"]


class Output(Request):
    """What the job hands back."""

    format: OutputFormat | None = Field(
        default=None,
        description="Format of the mesh that comes back; null: that of the upload, or `ply` for what was "
        "decoded. The task `encode` hands back `.qpz` only.",
        examples=["ply"],
    )
    attributes: list[CarriedAttribute] | None = Field(
        default=None,
        max_length=3,
        description="What the mesh carries besides its shape where `format` is another one than that of the upload; "
        "null: all that both formats know. In its own format it keeps everything.",
        examples=[["colours"]],
    )
    preview: bool = Field(default=True, description="Whether to draw a before/after picture.")
    closeups: bool = Field(
        default=False,
        description="Whether to draw each chosen hole before and after: a ZIP file of `hole_<id>.png`, at most 100 of "
        "them, the widest.",
    )
    html_report: bool = Field(
        default=False,
        description="Whether to write the report as a page for people and auditors as well, an HTML file that stands "
        "alone; the JSON report then has a `provenance`.",
    )
    tint: Tint = Field(
        default="invented",
        description="What the colours of invented surface say in pictures: `invented`, one colour; `confidence`, how "
        "sure it is.",
    )


class Limits(Request):
    """Ceilings of one attempt, at most those of the service. Null: those of the service."""

    time_s: float | None = Field(default=None, ge=1, le=86_400, description="Wall-clock seconds.", examples=[120.0])
    memory_mb: MemoryMb | None = Field(default=None, description="Memory of the engine, in MiB.", examples=[2048])


def _default_method(fields: dict[str, Any]) -> AutoMethod | DictionaryMethod:
    """Return the method of a job that names none: tasks other than `fill` go by what the mesh itself teaches."""
    if fields.get("task") == FILL:
        return AutoMethod(method="auto")
    return DictionaryMethod(method="dictionary", model=SELF)


class RepairSpec(Request):
    """What to do with a mesh."""

    task: Task = Field(
        default=FILL,
        description="`fill` closes holes; `restore` gives missing vertices a position; `denoise` takes noise from "
        "positions; `encode` compresses the surface into a `.qpz` file, and `decode` brings it back. `train` stands in "
        "jobs that `POST /v1/trainings` has made, and is refused elsewhere.",
        examples=["fill"],
    )
    method: Method = Field(
        default_factory=_default_method,
        description="How patches are completed or coded. `encode` and `decode` go by a dictionary, `denoise` by one or "
        "`smooth`. Left out, it is `auto` where the task is `fill`, else a dictionary, `self`. For `decode`, `self` "
        "means the dictionary that the file holds or names.",
    )
    restore: Restoring | None = Field(default=None, description="Options of the task `restore`, which needs them.")
    denoise: Denoising | None = Field(default=None, description="Options of the task `denoise`.")
    encode: Encoding | None = Field(default=None, description="Options of the task `encode`, which needs them.")
    holes: HoleSelection = Field(default_factory=HoleSelection, description="Which holes are filled.")
    weld_tolerance: Tolerance = Field(
        default="auto",
        description="How far apart boundary vertices are taken for one, in mesh units: 0 joins equal positions alone, "
        "`auto` what rounding in the file accounts for. Ids of holes are those found with `auto`, so that `holes.ids` "
        "and `holes.bridges` are refused with any other tolerance.",
        examples=["auto", 0.001],
    )
    colours: Colours = Field(
        default="auto",
        description="Colours of new vertices, where the mesh has colours of vertices, and of the texture page of new "
        "triangles, where it has texture images. `auto`: the texture around a hole is carried on where calibration "
        "finds that better; `harmonic`: the colours of the rim are spread.",
        examples=["auto"],
    )
    rule: str | None = Field(
        default=None,
        pattern=REFERENCE_PATTERN,
        description="A saved rule, `name` or `name@version`: it says `holes`, `method`, `colours` and `acceptance`, "
        "which are left out then.",
        examples=["castings"],
    )
    acceptance: Acceptance | None = Field(default=None, description="What every chosen hole of the result has to meet.")
    length_unit: LengthUnit | None = Field(
        default=None,
        description="Unit of the mesh's coordinates, where its file states none. What comes back as GLB is in metres "
        "then, and a 3MF names the unit: a scan in millimetres keeps its size. Null: that of the file, if any.",
        examples=["millimeter"],
    )
    output: Output = Field(default_factory=Output, description="What is handed back.")
    limits: Limits = Field(default_factory=Limits, description="Ceilings of one attempt.")
    seed: Seed = Field(default=0, description="Starts every random choice.", examples=[0])
    priority: Priority = Field(
        default="normal",
        description="`interactive`: before all others, for a station where a person waits; `bulk`: when no other job "
        "waits. Among jobs of one priority tenants take turns.",
        examples=["normal"],
    )
    label: Text | None = Field(default=None, description="A name for people.", examples=["station 4, part 1187"])
    metadata: Metadata = Field(
        default_factory=dict, description="Up to 16 facts of the sender's own, handed back unread."
    )
    callback_url: WebhookUrl | None = Field(
        default=None,
        description="Where to send the message of the job's end, besides to subscriptions; by the same rules, and "
        "signed with the tenant's callback secret (`POST /v1/callback-secret`).",
        examples=["https://mes.example.com/hooks/part-1187"],
    )

    @model_validator(mode="after")
    def _ids_need_the_known_holes(self) -> Self:
        if self.weld_tolerance != "auto" and self.holes.ids is not None:
            raise ValueError("holes.ids names holes found with the weld_tolerance auto: drop one of the two")
        if self.weld_tolerance != "auto" and self.holes.bridges:
            raise ValueError("holes.bridges names loops found with the weld_tolerance auto: drop one of the two")
        return self


class JobSpec(RepairSpec):
    """A whole job: a mesh, and what to do with it."""

    mesh_id: MeshId
    mesh_name: FileName | None = Field(
        default=None,
        description="Name of the mesh's file, after which the result is named; null: that of its latest upload. The "
        "same bytes may come as several files.",
        examples=["face000.ply"],
    )
    train: TrainingSpec | None = Field(
        default=None, description="Options of the task `train`, in jobs that `POST /v1/trainings` has made."
    )

    @property
    def reference_id(self) -> str | None:
        """Id of the mesh that the job learns from, None where it needs none."""
        if self.denoise is not None:
            return self.denoise.reference
        return self.method.learn_from if isinstance(self.method, DictionaryMethod) else None


# Fields that came after the first release of the contract, in groups that came together.
_FIELDS_OF_TASKS = {"task", "restore", "denoise", "encode"}
_FIELDS_OF_RULES = ({"rule"}, {"acceptance"})
_LATER_FIELDS = (
    _FIELDS_OF_TASKS,
    {"colours"},
    {"priority"},
    {"length_unit"},
    {"callback_url"},
    {"train"},
    *_FIELDS_OF_RULES,
)


def identity_of(spec: JobSpec) -> str:
    """Return the JSON text by which two requests for the same thing are known as such.

    It is what earlier versions wrote, which did not know all fields: a request that is repeated across an upgrade stays
    the same.
    """

    def is_default(name: str) -> bool:
        return bool(getattr(spec, name) == JobSpec.model_fields[name].default)

    unused = [group for group in _LATER_FIELDS if all(map(is_default, group))]
    left_out: dict[str, Any] = {name: True for group in unused for name in group}
    if not spec.holes.bridges:
        left_out["holes"] = {"bridges"}
    outputs = {
        "attributes": spec.output.attributes is None,
        "html_report": not spec.output.html_report,
        "tint": spec.output.tint == "invented",
    }
    left_out["output"] = {name for name, is_unused in outputs.items() if is_unused}
    if isinstance(spec.method, DictionaryMethod):
        later = {"learn_from": spec.method.learn_from is None, "dictionary": spec.method.dictionary == DictionarySize()}
        left_out["method"] = {name for name, is_unused in later.items() if is_unused}
    return spec.model_dump_json(exclude=left_out)
