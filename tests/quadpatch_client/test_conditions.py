import pytest

from quadpatch_client.conditions import first_fault, read_condition
from quadpatch_client.errors import UsageError


@pytest.mark.parametrize(
    ("text", "actual", "is_met"),
    [
        ("holes>0", 1, True),
        ("holes > 0", 0, False),
        ("triangles<=5e6", 5_000_000, True),
        ("size_mb<0.5", 0.6, False),
        ("vertices==7", 7, True),
        ("widest!=7", 7.0, False),
        ("widest>=7", None, False),
        ("name=*.stl", "a.stl", True),
        ("name!=*.stl", "a.stl", False),
    ],
)
def test_a_condition_is_met_or_says_why_not(text: str, actual: str | float | None, is_met: bool) -> None:
    condition = read_condition(text)
    fault = condition.fault(actual)
    assert (fault is None) == is_met
    assert fault is None or fault.startswith(f"{condition.quantity} is ")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("hols>0", "did you mean holes?"),
        ("colour=red", "there are name, size_mb"),
        ("holes", "say a quantity, a comparison and a value"),
        ("holes>many", "'many' is no number"),
        ("name>a", "compared by = or !="),
    ],
)
def test_what_is_no_condition_is_refused_in_words(text: str, words: str) -> None:
    with pytest.raises(UsageError) as caught:
        read_condition(text)
    assert words in str(caught.value)


def test_what_is_not_known_yet_is_no_reason() -> None:
    conditions = [read_condition("holes>0"), read_condition("name=*.ply")]
    assert first_fault(conditions, {"name": "a.ply"}) is None
    assert first_fault(conditions, {"name": "a.ply", "holes": 0}) == "holes is 0, not > 0"
