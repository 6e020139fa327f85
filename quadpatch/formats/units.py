"""Units of length: what a file states, or what the user declares of one that states none."""

from collections.abc import Mapping
from dataclasses import replace

from quadpatch.errors import OptionError
from quadpatch.formats.scan import Scan
from quadpatch_rules.option_words import LengthUnit

METRES: Mapping[str, float] = {
    "micron": 1e-6,
    "millimeter": 1e-3,
    "centimeter": 1e-2,
    "inch": 0.0254,
    "foot": 0.3048,
    "meter": 1.0,
}


def in_unit(scan: Scan, unit: LengthUnit | None) -> Scan:
    """Declare the unit of a scan's coordinates, whose numbers stay as they are; None declares none.

    Raises
    ------
    OptionError
        If the file states another one.
    """
    if unit is None or unit == scan.unit:
        return scan
    if scan.unit is not None:
        raise OptionError(f"the file says that its lengths are in {scan.unit}: drop length_unit, or say {scan.unit}")
    return replace(scan, unit=unit)
