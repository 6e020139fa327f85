import pytest

from quadpatch.options import HoleRule
from quadpatch_rules.rule_text import RuleTextError, read_bridge, read_rule


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("smooth", HoleRule("smooth")),
        (":skip", HoleRule("skip")),
        ("max_diameter=5:flat", HoleRule("flat", max_diameter=5.0)),
        ("id=3, id=4 : skip", HoleRule("skip", ids=(3, 4))),
        ("kind=open_end,min_diameter=1e-3,max_perimeter=9:model", HoleRule("model", None, "open_end", 1e-3, None, 9.0)),
    ],
)
def test_a_rule_is_read(text: str, rule: HoleRule) -> None:
    assert HoleRule.from_dict(read_rule(text)) == rule


@pytest.mark.parametrize("text", ["max_diameter:flat", "=5:flat", "id=1.5:skip", "width=3:flat"])
def test_what_is_no_rule_is_refused_with_an_example(text: str) -> None:
    with pytest.raises(RuleTextError, match="write it like max_diameter=5"):
        read_rule(text)


@pytest.mark.parametrize(("text", "pair"), [("3:17", (3, 17)), (" 0 : 1 ", (0, 1))])
def test_a_bridge_is_read(text: str, pair: tuple[int, int]) -> None:
    assert read_bridge(text) == pair


@pytest.mark.parametrize("text", ["", "3", "3:", "3:4:5", "-1:2", "a:b", "1.5:2", "\u0663:4"])
def test_what_is_no_bridge_is_refused_with_an_example(text: str) -> None:
    with pytest.raises(RuleTextError, match="like 3:17"):
        read_bridge(text)
