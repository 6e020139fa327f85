"""Options of denoising. Frozen; each default stands here and nowhere else. None means: the automatic rule.

Tested in `tests/quadpatch/denoising/test_denoise.py`.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from quadpatch.errors import OptionError
from quadpatch.options import PatchOptions, built, check_length_unit, check_seed
from quadpatch_rules.option_words import LengthUnit

Corner = tuple[float, float, float]


@dataclass(frozen=True)
class Box:
    """A box along the axes, by its smallest and its largest corner, in mesh units; its sides belong to it."""

    min: Corner
    max: Corner

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> "Box":
        """Build from `min` and `max`, three numbers each; anything else raises OptionError."""
        try:
            low, high = (tuple(float(number) for number in values[name]) for name in ("min", "max"))
        except (KeyError, TypeError, ValueError) as error:
            raise OptionError("region must have min and max, three numbers each") from error
        is_box = len(low) == len(high) == 3 and all(map(math.isfinite, low + high))
        if set(values) != {"min", "max"} or not is_box or any(a > b for a, b in zip(low, high, strict=True)):
            raise OptionError("region must have min and max, three finite numbers each, none of min above that of max")
        return cls((low[0], low[1], low[2]), (high[0], high[1], high[2]))


@dataclass(frozen=True)
class DenoiseOptions:
    """Everything that denoising can be told.

    Attributes
    ----------
    noise : float, optional
        Standard deviation of the noise along the normals, in mesh units; estimated where it is not given.
    max_shift : float, optional
        No vertex moves farther, in mesh units; `SHIFT_PER_NOISE` times the noise where it is not given.
    region : Box or str, optional
        Which vertices may move: those in a box, or those at which a vertex property of the PLY file is not 0.
    patches : PatchOptions
    seed : int
        Starts every random choice.
    length_unit : str, optional
        Unit of the scan's coordinates, where its file states none.
    """

    noise: float | None = None
    max_shift: float | None = None
    region: Box | str | None = None
    patches: PatchOptions = field(default_factory=PatchOptions)
    seed: int = 0
    length_unit: LengthUnit | None = None

    def __post_init__(self) -> None:
        check_length_unit(self.length_unit)
        for name in ("noise", "max_shift"):
            value = getattr(self, name)
            is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
            if value is not None and not (is_number and 0 < value < math.inf):
                raise OptionError(f"{name} must be finite and greater than 0; it is {value}")
        if not (self.region is None or isinstance(self.region, Box) or (isinstance(self.region, str) and self.region)):
            raise OptionError(f"region must be a box or the name of a vertex property; it is {self.region!r}")
        check_seed(self.seed)

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> "DenoiseOptions":
        """Build from nested plain values; an unknown name raises OptionError."""
        region = values.get("region")
        if isinstance(region, Mapping):
            values = {**values, "region": Box.from_dict(region)}
        return built(cls, values, patches=PatchOptions)
