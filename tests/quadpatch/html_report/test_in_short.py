"""The first lines of a page say what a restorer asks, in figures of the report."""

from pathlib import Path
from typing import Any

from quadpatch.html_report.in_short import QUESTIONS, in_short, outer_loops
from tests.quadpatch.html_report.pages import Page, ball, repaired_with_page


def hole(id_: int, verdict: str = "filled_smooth", **fields: Any) -> dict[str, Any]:
    row = {
        "id": id_, "verdict": verdict, "kind": "hole", "code": None, "confidence": 0.9, "expected_error": 0.02,
        "diameter": 2.0, "new_triangles": 10,
    }  # fmt: skip
    if verdict in {"skipped", "refused"}:
        row |= {"confidence": None, "expected_error": None, "new_triangles": 0}
    return row | fields


def report(*holes: dict[str, Any], **fields: Any) -> dict[str, Any]:
    return {
        "source": {"vertices": 1000, "triangles": 2000},
        "length_unit": "millimeter",
        "holes": list(holes),
        "warnings": [],
        "provenance": {"before": {"area": 75.0}, "after": {"area": 100.0}},
        **fields,
    }


def answers(*holes: dict[str, Any], **fields: Any) -> dict[str, str]:
    return {question: " ".join(one.text for one in said) for question, said in in_short(report(*holes, **fields))}


BORDER = hole(0, "skipped", kind="border", code="border")


def test_all_four_questions_are_answered_in_order() -> None:
    said = answers(BORDER, hole(1), hole(2, confidence=0.4, expected_error=0.3), hole(3, confidence=0.8))
    assert tuple(said) == QUESTIONS
    measured, invented, sure, todo = said.values()
    assert "1,000 vertices and 2,000 triangles" in measured
    assert "3 of 3 holes: 30 triangles, 25\u00a0% of the area" in invented
    assert "Half of the fills have 0.8 or more, the least sure one 0.4" in sure
    assert "off by 0.3 millimeter in the mean, 15\u00a0% of its width" in sure
    assert "Look at hole 2: it is the least sure (confidence 0.4, diameter 2 millimeter)." in todo
    assert "1 outer border stays open" in todo


def test_what_to_look_at_leads_to_its_hole() -> None:
    *_, (_, todo) = in_short(report(hole(4), hole(7, confidence=0.1), hole(9, "refused", code="folds_over")))
    assert [answer.hole for answer in todo] == [7, 9]


def test_holes_that_stay_open_are_named_with_what_to_do() -> None:
    wide = hole(0, "skipped", code="too_wide")
    todo = answers(wide, hole(1, "refused", code="folds_over"), hole(2, "refused", code="folds_over"), hole(3))
    said = todo[QUESTIONS[3]]
    assert "Holes 1 and 2 stay open: no sound fill was found. Look at their rims, or have them closed flat." in said
    assert "Hole 0 was left open by rule (too wide). If it is damage, choose it and repair again." in said
    many = answers(*(hole(i, "refused", code="folds_over") for i in range(8)))[QUESTIONS[3]]
    assert "8 holes (0, 1, 2, 3, 4 …) stay open" in many


def test_holes_that_miss_limits_come_first_and_warnings_last() -> None:
    unmet = [{"id": 5, "faults": ["confidence"]}]
    said = answers(hole(5), hole(6), acceptance={"unmet": unmet}, warnings=["a", "b"])[QUESTIONS[3]]
    assert said.startswith("Hole 5 misses the limits")
    assert said.endswith("Read the 2 warnings below.")


def test_what_is_not_known_or_not_there_is_said() -> None:
    unknown = answers(hole(1, confidence=None, expected_error=None))
    assert "no measure" in unknown[QUESTIONS[2]]
    some = answers(hole(1), hole(2, confidence=None, expected_error=None))
    assert "Of 1 fill there is no measure." in some[QUESTIONS[2]]
    nothing = answers()
    assert nothing[QUESTIONS[1]] == "Nothing: no hole was filled."
    assert nothing[QUESTIONS[3]] == "Nothing: there was no hole."


def test_a_border_is_no_damage_whatever_rule_leaves_it_open() -> None:
    by_hand = hole(1, "skipped", kind="border", code="rule")
    refused = hole(2, "refused", kind="border", code="folds_over")
    assert outer_loops([BORDER, by_hand, refused, hole(3, "skipped", code="too_wide")]) == [BORDER, by_hand]


def test_the_page_begins_with_them(tmp_path: Path) -> None:
    repaired = repaired_with_page(ball(tmp_path), tmp_path / "report.html")
    page = Page((tmp_path / "report.html").read_text("utf-8"))
    short = next(element for element in page.all("dl") if element.attributes["class"] == "short")
    for question, said in in_short(repaired.report):
        assert question in short.text
        assert all(answer.text in short.text for answer in said)
    links = [element.attributes["href"] for element in page.all("a") if "#hole-" in element.attributes["href"]]
    assert links
    assert all(page.by_id(link.removeprefix("#")) for link in links)
