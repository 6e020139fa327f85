from hypothesis import given
from hypothesis import strategies as st

from jobkit.schema import STAGES
from worker.progress import Progress

stages = st.sampled_from([*STAGES, "preview", "closeups", "something new"])


@given(st.lists(st.tuples(stages, st.floats(allow_nan=False))))
def test_the_percentage_never_falls_and_never_reaches_100(reports: list[tuple[str, float]]) -> None:
    progress = Progress()
    seen = [0.0]
    for stage, fraction in reports:
        progress.reach(stage, fraction)
        seen.append(progress.percent)
    assert seen == sorted(seen)
    assert seen[-1] <= 99.0


def test_every_stage_of_the_contract_moves_it_on() -> None:
    progress = Progress()
    for stage in [*STAGES, "preview", "closeups"]:
        before = progress.percent
        progress.reach(stage, 1.0)
        assert progress.stage == stage
        assert progress.percent > before
    assert progress.percent == 99.0
