import pytest

from quadpatch_rules.training_verdict import mean_ratio, verdict_of


@pytest.mark.parametrize(
    ("ratios", "text", "is_better"),
    [
        ([1.2, 1.5, 0.9, 1.02], "worse than the plain fill on 3 of 4 meshes", False),
        ([0.7, 0.8, 1.1], "better than the plain fill on 2 of 3 meshes", True),
        ([0.5], "better than the plain fill on 1 of 1 mesh", True),
        ([1.0, 0.995], "no better than the plain fill on 2 of 2 meshes", False),
        ([0.9, 1.1], "worse than the plain fill on 1 of 2 meshes", False),
        (
            [0.98, 0.97, 3.0],
            "worse than the plain fill on 1 of 3 meshes, and by more than it is better on the others",
            False,
        ),
        ([], "not judged: no mesh has room for a hole whose surface is known", False),
    ],
)
def test_a_verdict_counts_meshes_and_weighs_their_errors(ratios: list[float], text: str, is_better: bool) -> None:
    verdict = verdict_of(ratios)
    assert (verdict.text, verdict.is_better) == (text, is_better)


def test_the_mean_of_a_ratio_and_its_inverse_is_one() -> None:
    assert mean_ratio([0.25, 4.0]) == pytest.approx(1.0)
