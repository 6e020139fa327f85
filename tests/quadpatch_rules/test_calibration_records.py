import json
from collections.abc import Callable
from typing import Any

import pytest

from quadpatch_rules.calibration_records import MOST_BYTES, MOST_RECORDS, RecordError, read_records, write_records

KEY = "0123456789abcdef" * 4
THIRD = 1 / 3


def record(**changes: Any) -> dict[str, Any]:
    energies = [
        {"membrane": 0.3, "plate": 1.0, "variation": 0.0, "slope": 1.0},
        {"membrane": 0.0, "plate": 1.0, "variation": 0.0, "slope": 1.0},
    ]
    return {
        "energies": energies,
        "log_error": [-7.123456789012345, -708.4],
        "log_miss": [THIRD, -1e-300],
        "best": 1,
        "belief": 0.1 + 0.2,
        "widest": 0.7 - 0.1,
        "error_model": {"factor": 0.45, "slope": 0.9},
        "crease_share": 0.25,
        "is_graded": True,
        "weights": [[THIRD, 1 - THIRD]] * 24,
        "seconds": 0.75,
        **changes,
    }


def notes_on(value: Any) -> tuple[dict[str, Any], list[str]]:
    notes: list[str] = []
    return read_records(write_records({KEY: value}), notes.append), notes


def test_records_come_back_as_they_were_written() -> None:
    assert notes_on(record()) == ({KEY: record()}, [])
    assert notes_on(record(weights=None)) == ({KEY: record(weights=None)}, [])


WRONG: dict[str, dict[str, Any]] = {
    "no energies": {"energies": []},
    "an energy with a name too many": {
        "energies": [{"membrane": 0.0, "plate": 1.0, "variation": 0.0, "slope": 1.0, "more": 0.0}] * 2
    },
    "a negative weight of an energy": {
        "energies": [{"membrane": -1.0, "plate": 1.0, "variation": 0.0, "slope": 1.0}] * 2
    },
    "a number too few": {"log_error": [-7.0]},
    "a number that is a word": {"log_miss": ["0.0", 0.0]},
    "a whole number": {"log_miss": [0, 0.0]},
    "a position beyond the energies": {"best": 2},
    "a position that is no whole number": {"best": 1.0},
    "a position that is true": {"best": True},
    "a probability over 1": {"belief": 1.5},
    "a negative width": {"widest": -1.0},
    "a negative share": {"crease_share": -0.25},
    "a number in place of true": {"is_graded": 1},
    "a slope over 1": {"error_model": {"factor": 0.45, "slope": 1.5}},
    "no slope": {"error_model": {"factor": 0.45}},
    "weights of no hole": {"weights": []},
    "weights of one energy": {"weights": [[1.0]]},
    "weights that sum to 2": {"weights": [[1.0, 1.0]]},
    "a negative weight": {"weights": [[1.5, -0.5]]},
    "a field too many": {"path": "/etc/passwd"},
    "time that ran back": {"seconds": -1.0},
}


@pytest.mark.parametrize("name", WRONG)
def test_a_damaged_record_is_left_out_with_a_note(name: str) -> None:
    sound = {"f" * 64: record()}
    notes: list[str] = []
    assert read_records(write_records({KEY: record(**WRONG[name]), **sound}), notes.append) == sound
    (note,) = notes
    assert note.startswith("a kept calibration is left out: ")


@pytest.mark.parametrize("value", [None, [], 1.0, "record", {}])
def test_what_is_no_record_is_left_out(value: object) -> None:
    records, notes = notes_on(value)
    assert (records, len(notes)) == ({}, 1)


@pytest.mark.parametrize("key", ["", "../" + KEY[3:], KEY.upper(), KEY + "0", KEY + "\n"])
def test_a_record_under_what_is_no_key_is_left_out(key: str) -> None:
    assert read_records(write_records({key: record()})) == {}


NOT_KEPT: dict[str, Callable[[], bytes]] = {
    "nothing": lambda: b"",
    "no JSON": lambda: b"ply\nformat ascii 1.0\n",
    "no UTF-8": lambda: b"\xff\xfe",
    "other JSON": lambda: b'{"schema": 1, "holes": []}',
    "another kind": lambda: json.dumps({"kind": "calibration", "records": {}}).encode(),
    "a list of records": lambda: json.dumps({"kind": "quadpatch calibration", "records": []}).encode(),
    "NaN": lambda: write_records({KEY: record(belief=float("nan"))}),
    "infinity": lambda: write_records({KEY: record(seconds=1.0)}).replace(b'"seconds": 1.0', b'"seconds": 1e999'),
    "a name twice": lambda: write_records({KEY: record()}).replace(b'"belief"', b'"best": 0, "belief"'),
    "deep nesting": lambda: b"[" * 10_000,
    "many records": lambda: write_records({f"{i:064x}": record() for i in range(MOST_RECORDS + 1)}),
    "many bytes": lambda: write_records({}) + b" " * MOST_BYTES,
}


@pytest.mark.parametrize("name", NOT_KEPT)
def test_what_holds_no_kept_calibrations_is_refused(name: str) -> None:
    with pytest.raises(RecordError):
        read_records(NOT_KEPT[name]())


def test_the_largest_records_fit_into_the_limit() -> None:
    five = [{"membrane": THIRD, "plate": THIRD, "variation": THIRD, "slope": THIRD}] * 5
    numbers, weights = [-THIRD * 1e-300] * 5, [[THIRD, THIRD, THIRD / 3, THIRD / 3, THIRD / 3]] * 24
    largest = record(energies=five, log_error=numbers, log_miss=numbers, weights=weights)
    records = {f"{i:064x}": largest for i in range(MOST_RECORDS)}
    assert read_records(write_records(records)) == records
