"""What a file of kept calibrations must hold: checked where one is read, and before one is stored or handed on.

It is JSON: `{"kind": "quadpatch calibration", "records": {key: record}}`. The key is a hash of all that the calibration
depends on; a record holds numbers alone, as `quadpatch.calibration.record.CalibrationRecord` describes them.
"""

import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from quadpatch_rules.strict_json import StrictJsonError, read_json

KIND = "quadpatch calibration"

# Of one file; the oldest are dropped. Repairs of a large scan by models with patches of other lengths look at other
# parts of it, so a scan can have several.
MOST_RECORDS = 8
# A record takes under 4 KiB.
MOST_BYTES = 1 << 16

# Weights of one hole sum to 1 within this: they are rounded once for each energy.
_ROUNDING = 1e-12
_KEY = re.compile(r"[0-9a-f]{64}")
_WEIGHTS = ("membrane", "plate", "variation", "slope")
_FIELDS = (
    *("energies", "log_error", "log_miss", "best", "belief", "widest"),
    *("error_model", "crease_share", "is_graded", "weights", "seconds"),
)


class RecordError(ValueError):
    """What was read holds no kept calibrations, or a record of it is damaged; the message says why."""


def read_records(data: bytes, note: Callable[[str], object] = lambda _: None) -> dict[str, dict[str, Any]]:
    """Read kept calibrations, of which nothing is trusted.

    Parameters
    ----------
    data : bytes
    note : callable
        Told why a record was left out; the others are kept.

    Returns
    -------
    dict
        Records by key, oldest first.

    Raises
    ------
    RecordError
        If it is something else.
    """
    records = {}
    for key, record in _rows(data).items():
        try:
            check_record(record)
        except RecordError as error:
            note(f"a kept calibration is left out: {error}")
            continue
        if _KEY.fullmatch(key):
            records[key] = record
    return records


def write_records(records: Mapping[str, Mapping[str, Any]]) -> bytes:
    """Write records by key as `read_records` reads them: floats have the digits that give them back bit for bit."""
    return (json.dumps({"kind": KIND, "records": records}) + "\n").encode()


def check_record(record: Any) -> None:
    """Raise RecordError for what is no record of a calibration."""
    fields = _mapping(record, _FIELDS)
    n = _check_blend(fields)
    model = _mapping(fields["error_model"], ("factor", "slope"))
    _number(model["factor"], 0.0)
    _number(model["slope"], 0.0, 1.0)
    _number(fields["crease_share"], 0.0, 1.0)
    _number(fields["seconds"], 0.0)
    if type(fields["is_graded"]) is not bool:
        raise RecordError("is_graded is neither true nor false")
    for weights in [] if fields["weights"] is None else _list(fields["weights"]):
        if abs(sum(_row(weights, n, 0.0)) - 1.0) > _ROUNDING:
            raise RecordError("weights of a hole don't sum to 1")


def _check_blend(fields: Mapping[str, Any]) -> int:
    """Check how holes are filled; return the count of energies."""
    energies, best = _list(fields["energies"]), fields["best"]
    for energy in energies:
        for weight in _mapping(energy, _WEIGHTS).values():
            _number(weight, 0.0)
    for name in ("log_error", "log_miss"):
        _row(fields[name], len(energies))
    _number(fields["belief"], 0.0, 1.0)
    _number(fields["widest"], 0.0)
    if type(best) is not int or not 0 <= best < len(energies):
        raise RecordError("best names no energy")
    return len(energies)


def _rows(data: bytes) -> dict[str, Any]:
    if len(data) > MOST_BYTES:
        raise RecordError(f"it has over {MOST_BYTES:,} bytes, and kept calibrations never do")
    try:
        document = read_json(data)
    except StrictJsonError as error:
        raise RecordError(str(error)) from error
    rows = _mapping(document, ("kind", "records"))["records"]
    if document["kind"] != KIND or not isinstance(rows, dict) or len(rows) > MOST_RECORDS:
        raise RecordError(f"its kind is not {KIND!r}, or it holds no object of at most {MOST_RECORDS} records")
    return rows


def _mapping(value: Any, names: Sequence[str]) -> Mapping[str, Any]:
    if not isinstance(value, dict) or value.keys() != set(names):
        raise RecordError(f"there is no object of {', '.join(names)}")
    return value


def _list(value: Any) -> list[Any]:
    if not isinstance(value, list) or not value:
        raise RecordError("there is no list, or nothing in it")
    return value


def _row(value: Any, n: int, least: float = -math.inf) -> list[float]:
    if len(_list(value)) != n:
        raise RecordError(f"a list has {len(value)} numbers in place of {n}")
    return [_number(item, least) for item in value]


def _number(value: Any, least: float, most: float = math.inf) -> float:
    """Take a finite float between two bounds; whole numbers, which are written with a point here, are refused too."""
    if type(value) is not float or not math.isfinite(value) or not least <= value <= most:
        raise RecordError(f"there is no number between {least} and {most}")
    return value
