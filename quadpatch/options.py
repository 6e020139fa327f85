"""Options of every stage. Frozen; each default stands here and nowhere else. None means: the automatic rule."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

from quadpatch.errors import OptionError

RESOLUTION_RANGE = (8, 128)
OVERLAP_RANGE = (0, 8)
ATOMS_RANGE = (2, 4096)
NONZERO_RANGE = (1, 256)
STEPS_RANGE = (1, 100_000)

# Options that are groups of their own.
_NESTED = ("holes", "patches", "dictionary", "network")

# How a model's patches become surface: `default` is this project's own way, `paper` that of the paper, step by step.
Recipe = Literal["default", "paper"]


@dataclass(frozen=True)
class HoleOptions:
    """Which holes to fill.

    By default every one but outer borders of pieces, and those wider than a quarter of the bounding box's diagonal.

    Attributes
    ----------
    max_diameter, max_perimeter : float, optional
        In mesh units.
    all_but_largest : bool
        Leave the loop with the longest perimeter open.
    ids : tuple of int, optional
        Just these.
    """

    max_diameter: float | None = None
    max_perimeter: float | None = None
    all_but_largest: bool = False
    ids: tuple[int, ...] | None = None

    def __post_init__(self) -> None:
        _check_length("holes.max_diameter", self.max_diameter)
        _check_length("holes.max_perimeter", self.max_perimeter)

    @property
    def is_automatic(self) -> bool:
        """Whether the user gave no rule at all."""
        return self == HoleOptions()


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
    """

    length: float | None = None
    resolution: int | None = None
    overlap: int | None = None

    def __post_init__(self) -> None:
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
        At most so many, of 64 patches each.
    seconds : float
        At most so long, lessons included. Where it ends before the steps do, another run may give other bytes.
    """

    steps: int = 1000
    seconds: float = 600.0

    def __post_init__(self) -> None:
        _check_range("network.steps", self.steps, STEPS_RANGE)
        if not (self.seconds > 0 and math.isfinite(self.seconds)):
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
    """

    holes: HoleOptions = field(default_factory=HoleOptions)
    patches: PatchOptions = field(default_factory=PatchOptions)
    seed: int = 0
    recipe: Recipe = "default"
    dictionary: DictionaryOptions = field(default_factory=DictionaryOptions)
    network: NetworkOptions = field(default_factory=NetworkOptions)
    weld_tolerance: float | Literal["auto"] = "auto"

    def __post_init__(self) -> None:
        check_weld_tolerance(self.weld_tolerance)
        if self.recipe not in get_args(Recipe):
            raise OptionError(f"recipe must be one of {', '.join(get_args(Recipe))}; it is {self.recipe!r}")
        if self.recipe != "paper" and self.dictionary != DictionaryOptions():
            raise OptionError("dictionary.atoms and dictionary.nonzero go with the recipe paper only")
        if not isinstance(self.seed, int) or self.seed < 0:
            raise OptionError(f"seed must be a whole number of 0 or more; it is {self.seed}")

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> "RepairOptions":
        """Build from nested plain values; an unknown name raises OptionError."""
        try:
            holes = dict(values.get("holes") or {})
            if holes.get("ids") is not None:
                holes["ids"] = tuple(int(i) for i in holes["ids"])
            patches = dict(values.get("patches") or {})
            dictionary = DictionaryOptions(**(values.get("dictionary") or {}))
            network = NetworkOptions(**(values.get("network") or {}))
            rest = {name: value for name, value in values.items() if name not in _NESTED}
            return cls(HoleOptions(**holes), PatchOptions(**patches), dictionary=dictionary, network=network, **rest)
        except (TypeError, ValueError) as error:
            raise OptionError(f"options don't fit: {error}") from error


def check_weld_tolerance(value: object) -> None:
    """Raise OptionError for a tolerance that is neither `auto` nor a finite length of 0 or more."""
    is_length = isinstance(value, (int, float)) and not isinstance(value, bool) and 0 <= value < math.inf
    if value != "auto" and not is_length:
        raise OptionError(f"weld_tolerance must be auto, or finite and 0 or more; it is {value}")


def _check_length(name: str, value: float | None) -> None:
    if value is not None and not (value > 0 and math.isfinite(value)):
        raise OptionError(f"{name} must be finite and greater than 0; it is {value}")


def _check_range(name: str, value: int | None, limits: tuple[int, int]) -> None:
    if value is not None and not (isinstance(value, int) and limits[0] <= value <= limits[1]):
        raise OptionError(f"{name} must be a whole number between {limits[0]} and {limits[1]}; it is {value}")
