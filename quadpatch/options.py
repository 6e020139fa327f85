"""Options of every stage. Frozen; each default stands here and nowhere else. None means: the automatic rule."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, TypeVar, get_args

from quadpatch.errors import OptionError
from quadpatch_rules.hole_selection import MODEL_FILLS_ONLY, Cap, HoleKind, RuleAction, names_fills, repeated_loop
from quadpatch_rules.option_words import CarriedAttribute, Colours, Effort, LengthUnit, Preset, Recipe

RESOLUTION_RANGE = (8, 128)
OVERLAP_RANGE = (0, 8)
ATOMS_RANGE = (2, 4096)
NONZERO_RANGE = (1, 256)
STEPS_RANGE = (1, 100_000)

Options = TypeVar("Options")

# Options that are groups of their own.
_NESTED = ("holes", "patches", "dictionary", "network")


@dataclass(frozen=True)
class HoleRule:
    """What to do with the holes that meet all of some conditions; one without conditions is about every hole.

    A rule that names neither ids nor a kind passes by the borders and open ends that no other option asks for.

    Attributes
    ----------
    action : str
        `skip` leaves them open; `model`, `smooth` and `flat` say how they are closed.
    ids : tuple of int, optional
    kind : str, optional
        `hole`, `slit`, `open_end` or `border`.
    min_diameter, max_diameter, max_perimeter : float, optional
        In mesh units; a hole of just that size meets the condition.
    """

    action: RuleAction
    ids: tuple[int, ...] | None = None
    kind: HoleKind | None = None
    min_diameter: float | None = None
    max_diameter: float | None = None
    max_perimeter: float | None = None

    def __post_init__(self) -> None:
        _check_choice("holes.rules.action", self.action, get_args(RuleAction))
        if self.kind is not None:
            _check_choice("holes.rules.kind", self.kind, get_args(HoleKind))
        for name in ("min_diameter", "max_diameter", "max_perimeter"):
            _check_length(f"holes.rules.{name}", getattr(self, name))

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> "HoleRule":
        """Build from plain values; an unknown name raises TypeError."""
        return cls(**_with_ids(values))


@dataclass(frozen=True)
class HoleOptions:
    """Which holes to fill, and how.

    By default every hole and slit is filled, outer borders of pieces and open ends stay open, and so do holes wider
    than a quarter of the bounding box's diagonal. What is given here adds up: ids together with max_diameter means
    those of the ids that are no wider.

    Attributes
    ----------
    max_diameter, max_perimeter : float, optional
        In mesh units. Wider or longer ones stay open, whatever else asks for them.
    all_but_largest : bool
        Leave the widest loop open.
    ids : tuple of int, optional
        Just these, borders and open ends among them.
    include_borders : bool
        Treat outer borders of pieces like holes.
    cap : str, optional
        `flat`: close open ends by a plane patch.
    rules : tuple of HoleRule
        The first one whose conditions a hole meets says what is done with it.
    bridges : tuple of (int, int)
        Pairs of loops that a strip of surface joins, whatever else is said of these.
    """

    max_diameter: float | None = None
    max_perimeter: float | None = None
    all_but_largest: bool = False
    ids: tuple[int, ...] | None = None
    include_borders: bool = False
    cap: Cap | None = None
    rules: tuple[HoleRule, ...] = ()
    bridges: tuple[tuple[int, int], ...] = ()

    def __post_init__(self) -> None:
        _check_length("holes.max_diameter", self.max_diameter)
        _check_length("holes.max_perimeter", self.max_perimeter)
        if self.cap is not None:
            _check_choice("holes.cap", self.cap, get_args(Cap))
        repeated = repeated_loop(self.bridges)
        if repeated is not None:
            raise OptionError(f"holes.bridges: {repeated}")

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> "HoleOptions":
        """Build from plain values; an unknown name raises TypeError."""
        rules = tuple(HoleRule.from_dict(rule) for rule in values.get("rules") or ())
        bridges = tuple((int(first), int(second)) for first, second in values.get("bridges") or ())
        return cls(**{**_with_ids(values), "rules": rules, "bridges": bridges})


def _with_ids(values: Mapping[str, Any]) -> dict[str, Any]:
    """Copy plain values, with their list of ids as a tuple."""
    copied = dict(values)
    ids = copied.get("ids")
    return {**copied, "ids": None if ids is None else tuple(int(i) for i in ids)}


@dataclass(frozen=True)
class PatchOptions:
    """How patches are laid out.

    Attributes
    ----------
    length : float, optional
        Side of a patch in mesh units.
    resolution : int, optional
        Bins along one side; a learned model brings its own.
    overlap : int, optional
        k of the paper: besides its centre, every quad carries 4 k offset patches.
    preset : str, optional
        `type1` or `type2`: length and resolution of the paper's two kinds of patches, in place of one's own.
    """

    length: float | None = None
    resolution: int | None = None
    overlap: int | None = None
    preset: Preset | None = None

    def __post_init__(self) -> None:
        if self.preset is not None:
            _check_choice("patches.preset", self.preset, get_args(Preset))
            if self.length is not None or self.resolution is not None:
                raise OptionError("patches.preset says length and resolution: drop it, or drop these")
        _check_length("patches.length", self.length)
        _check_range("patches.resolution", self.resolution, RESOLUTION_RANGE)
        _check_range("patches.overlap", self.overlap, OVERLAP_RANGE)


@dataclass(frozen=True)
class DictionaryOptions:
    """How large a dictionary is learned from the mesh itself; read by the recipe `paper` alone.

    Attributes
    ----------
    atoms : int, optional
        At most so many; there are never more than patches to learn from.
    nonzero : int, optional
        Atoms that one patch may use.
    """

    atoms: int | None = None
    nonzero: int | None = None

    def __post_init__(self) -> None:
        _check_range("dictionary.atoms", self.atoms, ATOMS_RANGE)
        _check_range("dictionary.nonzero", self.nonzero, NONZERO_RANGE)


@dataclass(frozen=True)
class NetworkOptions:
    """How long a network is fitted to the mesh itself.

    Attributes
    ----------
    steps : int
        At most so many, of 64 patches each; fewer where calibration holes gain nothing more.
    seconds : float, optional
        At most so long, cutting training pairs included. Where this ends it, another run may give other bytes.
    """

    steps: int = 800
    seconds: float | None = None

    def __post_init__(self) -> None:
        _check_range("network.steps", self.steps, STEPS_RANGE)
        if self.seconds is not None and not (self.seconds > 0 and math.isfinite(self.seconds)):
            raise OptionError(f"network.seconds must be finite and greater than 0; it is {self.seconds}")


@dataclass(frozen=True)
class RepairOptions:
    """Everything that a repair can be told.

    Attributes
    ----------
    holes : HoleOptions
    patches : PatchOptions
    seed : int
        Starts every random choice.
    recipe : str
        `default` or `paper`.
    dictionary : DictionaryOptions
    network : NetworkOptions
        Read where a network is fitted to the mesh.
    weld_tolerance : float or "auto"
        How far apart boundary vertices are taken for one, in mesh units: 0 for equal positions alone, `auto` for what
        rounding in the file accounts for.
    effort : str
        How much the model `auto` tries: `fast`, `standard` or `best`.
    colours : str
        Of new vertices where measured ones have colours, and of texture pages where there are images: `auto` carries
        the texture on where calibration says that this is better, `harmonic` only spreads the colours of the rim.
    length_unit : str, optional
        Unit of the scan's coordinates, where its file states none: `millimeter`, `meter` and others. Formats whose
        lengths have a unit, glTF and 3MF, then hold the scan in its true size.
    attributes : tuple of str, optional
        What a mesh carries that is written in another format than its own: some of `colours`, `normals` and
        `texture_coordinates`; None: all that both formats know. In its own format a scan keeps everything.
    """

    holes: HoleOptions = field(default_factory=HoleOptions)
    patches: PatchOptions = field(default_factory=PatchOptions)
    seed: int = 0
    recipe: Recipe = "default"
    dictionary: DictionaryOptions = field(default_factory=DictionaryOptions)
    network: NetworkOptions = field(default_factory=NetworkOptions)
    weld_tolerance: float | Literal["auto"] = "auto"
    effort: Effort = "standard"
    colours: Colours = "auto"
    length_unit: LengthUnit | None = None
    attributes: tuple[CarriedAttribute, ...] | None = None

    def __post_init__(self) -> None:
        _check_choice("colours", self.colours, get_args(Colours))
        check_length_unit(self.length_unit)
        for name in self.attributes or ():
            _check_choice("attributes", name, get_args(CarriedAttribute))
        check_weld_tolerance(self.weld_tolerance)
        _check_choice("recipe", self.recipe, get_args(Recipe))
        _check_choice("effort", self.effort, get_args(Effort))
        if self.recipe == "paper" and names_fills(self.holes):
            raise OptionError(MODEL_FILLS_ONLY)
        if self.recipe != "paper" and self.dictionary != DictionaryOptions():
            raise OptionError("dictionary.atoms and dictionary.nonzero go with the recipe paper only")
        check_seed(self.seed)

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> "RepairOptions":
        """Build from nested plain values; an unknown name raises OptionError."""
        try:
            holes = HoleOptions.from_dict(dict(values.get("holes") or {}))
            patches = dict(values.get("patches") or {})
            dictionary = DictionaryOptions(**(values.get("dictionary") or {}))
            network = NetworkOptions(**(values.get("network") or {}))
            rest = {name: value for name, value in values.items() if name not in _NESTED}
            if rest.get("attributes") is not None:
                rest["attributes"] = tuple(rest["attributes"])
            return cls(holes, PatchOptions(**patches), dictionary=dictionary, network=network, **rest)
        except (TypeError, ValueError) as error:
            raise OptionError(f"options don't fit: {error}") from error


def built(cls: Callable[..., Options], values: Mapping[str, Any], **groups: Callable[..., Any]) -> Options:
    """Build options from nested plain values.

    Parameters
    ----------
    cls : type
        A dataclass of options.
    values : mapping
    groups : type
        Of the options that are groups of their own, by name.

    Raises
    ------
    OptionError
        If a name is unknown or a value refused.
    """
    try:
        made = {name: make(**(values.get(name) or {})) for name, make in groups.items()}
        return cls(**{**values, **made})
    except (TypeError, ValueError) as error:
        raise OptionError(f"options don't fit: {error}") from error


def check_length_unit(value: str | None) -> None:
    """Raise OptionError for a unit that is not known."""
    if value is not None:
        _check_choice("length_unit", value, get_args(LengthUnit))


def check_seed(value: object) -> None:
    """Raise OptionError for a seed that is no whole number of 0 or more."""
    if isinstance(value, bool) or not isinstance(value, int) or value < 0:
        raise OptionError(f"seed must be a whole number of 0 or more; it is {value}")


def check_weld_tolerance(value: object) -> None:
    """Raise OptionError for a tolerance that is neither `auto` nor a finite length of 0 or more."""
    is_length = isinstance(value, (int, float)) and not isinstance(value, bool) and 0 <= value < math.inf
    if value != "auto" and not is_length:
        raise OptionError(f"weld_tolerance must be auto, or finite and 0 or more; it is {value}")


def _check_length(name: str, value: float | None) -> None:
    if value is not None and not (value > 0 and math.isfinite(value)):
        raise OptionError(f"{name} must be finite and greater than 0; it is {value}")


def _check_choice(name: str, value: str, choices: tuple[str, ...]) -> None:
    if value not in choices:
        raise OptionError(f"{name} must be one of {', '.join(choices)}; it is {value!r}")


def _check_range(name: str, value: int | None, limits: tuple[int, int]) -> None:
    if value is not None and not (isinstance(value, int) and limits[0] <= value <= limits[1]):
        raise OptionError(f"{name} must be a whole number between {limits[0]} and {limits[1]}; it is {value}")
