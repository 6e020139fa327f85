import pytest

from quadpatch_client.errors import UsageError
from quadpatch_client.options import HoleChoice, MethodChoice
from quadpatch_client.spec import make_spec
from quadpatch_client.wording import suggestion


@pytest.mark.parametrize(
    ("holes", "method", "rest", "words"),
    [
        (HoleChoice(max_diameter=-1.0), MethodChoice(), {}, "--max-diameter has to be greater than 0, not -1"),
        (
            HoleChoice(max_diameter=float("inf")),
            MethodChoice(),
            {},
            "--max-diameter has to be a finite number, not inf",
        ),
        (HoleChoice(ids=[-3]), MethodChoice(), {}, "--hole has to be at least 0, not -3"),
        (HoleChoice(), MethodChoice("dictionary", length=0.0), {}, "--patch-length has to be greater than 0, not 0"),
        (HoleChoice(), MethodChoice("cnn", "self", fit_steps=0), {}, "--fit-steps has to be at least 1, not 0"),
        (HoleChoice(), MethodChoice(model="a b"), {}, "--model has to be name, name@version or 'self', not 'a b'"),
        (HoleChoice(), MethodChoice(), {"seed": -1}, "--seed has to be at least 0, not -1"),
        (HoleChoice(), MethodChoice(), {"label": "a\nb"}, "--label has to be text without control characters"),
        (HoleChoice(), MethodChoice(), {"weld_tolerance": "wide"}, "--weld-tolerance has to be"),
        (HoleChoice(rules=["max_diameter=-5:smooth"]), MethodChoice(), {}, "--rule has to be greater than 0, not -5"),
    ],
)
def test_errors_name_the_option_and_what_it_may_be(
    holes: HoleChoice, method: MethodChoice, rest: dict[str, object], words: str
) -> None:
    with pytest.raises(UsageError) as caught:
        make_spec("0" * 64, holes, method, **rest)
    assert str(caught.value).startswith(words)
    for jargon in ("Input should", "body", "pydantic", "method.", "holes."):
        assert jargon not in str(caught.value)


def test_several_errors_are_told_at_once() -> None:
    with pytest.raises(UsageError) as caught:
        make_spec("0" * 64, HoleChoice(max_diameter=-1.0), MethodChoice(), seed=-1)
    assert str(caught.value).count("has to be") == 2


def test_what_was_meant_is_asked_for_where_something_is_alike() -> None:
    assert suggestion("smoth", ["smooth", "self"]) == "; did you mean 'smooth'?"
    assert suggestion("xyz", ["smooth", "self"]) == ""
