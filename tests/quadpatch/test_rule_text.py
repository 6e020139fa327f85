import pytest

from client import rule_text as of_client
from quadpatch.errors import OptionError
from quadpatch.options import HoleRule
from quadpatch.rule_text import read_rule


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
    assert read_rule(text) == rule
    # The client, which may not import the method, reads the same words.
    values = of_client.read_rule(text)
    ids = values.pop("ids", None)
    assert HoleRule(**values, ids=tuple(ids) if ids else None) == rule


@pytest.mark.parametrize("text", ["", "fill", "max_diameter:flat", "=5:flat", "max_diameter=-5:flat", "id=1.5:skip"])
def test_what_is_no_rule_is_refused_with_a_code(text: str) -> None:
    with pytest.raises(OptionError) as caught:
        read_rule(text)
    assert caught.value.code == "invalid_option"
