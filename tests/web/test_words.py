"""The words of the page, held to each other and to the codes of the service."""

import ast
import re
from pathlib import Path
from string import Formatter
from typing import get_args

import pytest

from quadpatch_client.schema.codes import FAILURE_CODES
from quadpatch_client.schema.models import ModelKind
from quadpatch_client.schema.reports import HoleVerdict
from quadpatch_client.schema.states import ModelState
from quadpatch_rules.coded_warnings import WARNINGS
from quadpatch_rules.hole_selection import HoleKind, RuleAction
from service.contract.codes import problem_codes

ROOT = Path(__file__).parents[2]
TEXT = ROOT / "web" / "src" / "text"
# Words that are the same in both languages.
ALIKE = {"alias", "format", "version", "name", "reference", "system", "scan", "section_scans", "unit_unknown", "patch"}


def words(*names: str) -> dict[str, str]:
    """Return the sentences of files, by their keys."""
    found: dict[str, str] = {}
    for name in names:
        pairs = re.findall(r'^  (\w+):\s+("(?:[^"\\]|\\.)*"),$', (TEXT / name).read_text("utf-8"), re.MULTILINE)
        found |= {key: ast.literal_eval(text) for key, text in pairs}
    return found


EN, DE = words("en.ts", "en_codes.ts"), words("de.ts", "de_codes.ts")
OF_SERVICE = words("de_service.ts")


def placeholders(sentence: str) -> set[str]:
    return {name for _, name, _, _ in Formatter().parse(sentence) if name is not None}


def test_both_languages_have_the_same_keys_and_values() -> None:
    assert len(EN) > 300
    assert EN.keys() == DE.keys()
    assert not [key for key in EN if placeholders(EN[key]) != placeholders(DE[key])]


def test_no_sentence_is_the_same_in_both_languages_by_mistake() -> None:
    assert {key for key in EN if EN[key] == DE[key]} <= ALIKE | {
        key for key in EN if not re.search("[a-z]{4}", EN[key])
    }


@pytest.mark.parametrize(
    ("group", "codes"),
    [
        ("warning", list(WARNINGS)),
        ("failure", list(FAILURE_CODES)),
        ("problem", problem_codes()),
    ],
)
def test_every_code_of_the_service_has_german_words(group: str, codes: list[str]) -> None:
    german = DE | OF_SERVICE
    assert not [code for code in codes if f"{group}_{code}" not in german]


def test_german_words_are_of_codes_that_there_are_and_stand_once() -> None:
    known = {
        *(f"warning_{code}" for code in WARNINGS),
        *(f"failure_{code}" for code in FAILURE_CODES),
        *(f"problem_{code}" for code in problem_codes()),
    }
    assert not [key for key in OF_SERVICE if key not in known and not key.startswith("field_")]
    assert not OF_SERVICE.keys() & DE.keys()


@pytest.mark.parametrize("code", WARNINGS)
def test_german_warnings_name_no_value_that_is_not_there(code: str) -> None:
    values = {"missed", "holes"} if code == "limits_missed" else placeholders(WARNINGS[code])
    assert placeholders(OF_SERVICE[f"warning_{code}"]) <= values


def reasons() -> set[str]:
    """Return the codes of reasons of holes that stand in the method."""
    sources = [
        ROOT / "client" / "quadpatch_rules" / "hole_selection.py",
        *(ROOT / "quadpatch" / "recipes").glob("*.py"),
    ]
    text = "".join(path.read_text("utf-8") for path in sources)
    found = re.findall(r'"([a-z_]+)",\s*f?"[^"]* [^"]*"', text)
    return {*found, *re.findall(r'"(?:filled_smooth|refused)", "(\w+)"', text), *re.findall(r'code="(\w+)"', text)}


@pytest.mark.parametrize(
    ("group", "codes"),
    [
        ("reason", sorted(reasons())),
        ("verdict", get_args(HoleVerdict)),
        ("kind", get_args(HoleKind)),
        ("action", get_args(RuleAction)),
        ("model_state", list(ModelState)),
        ("model_kind", get_args(ModelKind)),
    ],
)
def test_every_value_that_is_shown_has_words(group: str, codes: list[str]) -> None:
    assert codes
    assert not [code for code in codes if f"{group}_{code}" not in EN]
