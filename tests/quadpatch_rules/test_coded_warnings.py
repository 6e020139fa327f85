import json
import math
import pickle
from string import Formatter

import pytest

from quadpatch_rules.coded_warnings import OTHER, WARNINGS, CodedWarning, add_warning, described, warning


def test_a_warning_is_a_sentence_that_knows_its_code_and_values() -> None:
    made = warning("surface_doubled", copies=1200, faces=2400)
    assert made.startswith("1,200 of 2,400 faces are exact copies")
    assert (made.code, made.values) == ("surface_doubled", {"copies": 1200, "faces": 2400})


def test_a_report_has_codes_beside_its_sentences_and_is_json() -> None:
    report = described([warning("no_noise"), "a sentence of its own"])
    add_warning(report, warning("coordinates_rounded", rounding=math.inf))
    assert json.loads(json.dumps(report, allow_nan=False)) == report
    assert [detail["message"] for detail in report["warning_details"]] == report["warnings"]
    assert [detail["code"] for detail in report["warning_details"]] == ["no_noise", OTHER, "coordinates_rounded"]
    assert report["warning_details"][2]["values"] == {"rounding": "inf"}
    assert all(type(sentence) is str for sentence in report["warnings"])


def test_warnings_that_had_no_details_get_some_when_one_is_added() -> None:
    report = {"warnings": ["of an earlier version"]}
    add_warning(report, warning("no_noise"))
    details = described(["of an earlier version", warning("no_noise")])
    assert report == details


def test_what_is_not_printable_stays_out_of_values() -> None:
    made = warning("no_preview", reason="a\x1b[2Jb")
    assert "\x1b" not in made
    assert "\x1b" not in str(made.values)


def test_a_warning_passes_between_processes() -> None:
    made = warning("no_close_up", hole=3, reason="no memory")
    again = pickle.loads(pickle.dumps(made))
    assert isinstance(again, CodedWarning)
    assert (again, again.code, again.values) == (made, made.code, made.values)


@pytest.mark.parametrize("code", WARNINGS)
def test_a_sentence_names_its_values_and_numbers_them_not(code: str) -> None:
    names = [name for _, name, _, _ in Formatter().parse(WARNINGS[code]) if name is not None]
    assert all(name.isidentifier() for name in names)
    assert len(set(names)) == len(names)
