import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch_client.schema import STAGES, TASKS, Task
from worker.progress import FilledBy, Progress

stages = st.sampled_from([*STAGES, "preview", "closeups", "html_report", "something new"])


@given(st.sampled_from(TASKS), st.lists(st.tuples(stages, st.floats(allow_nan=False))))
def test_the_percentage_never_falls_and_never_reaches_100(task: Task, reports: list[tuple[str, float]]) -> None:
    progress = Progress(task)
    seen = [0.0]
    for stage, fraction in reports:
        progress.reach(stage, fraction)
        seen.append(progress.percent)
    assert seen == sorted(seen)
    assert seen[-1] <= 99.0


def test_every_stage_of_the_contract_moves_it_on() -> None:
    progress = Progress()
    for stage in [*STAGES, "preview", "closeups", "html_report"]:
        before = progress.percent
        progress.reach(stage, 1.0)
        assert progress.stage == stage
        assert progress.percent > before
    assert progress.percent == 99.0


@pytest.mark.parametrize(("by", "longest"), [("geometry", "fill"), ("model", "fill"), ("fitting", "learn")])
def test_no_stage_of_a_repair_takes_longer_than_that_of_what_fills_holes(by: FilledBy, longest: str) -> None:
    progress = Progress(filled_by=by)
    shares = {}
    for stage in [*STAGES, "preview", "closeups", "html_report"]:
        before = progress.percent
        progress.reach(stage, 1.0)
        shares[stage] = progress.percent - before
    assert max(shares, key=lambda stage: shares[stage]) == longest
    assert progress.percent == 99.0


def test_a_repair_by_geometry_spends_most_of_its_time_filling() -> None:
    progress = Progress(filled_by="geometry")
    progress.reach("fill", 0.0)
    start = progress.percent
    progress.reach("fill", 0.5)
    assert progress.percent - start > 30.0
    for stage in ("judge", "write", "preview", "closeups", "html_report"):
        progress.reach(stage, 1.0)
    assert progress.percent == 99.0


@pytest.mark.parametrize("task", TASKS)
def test_a_task_that_reaches_its_picture_is_all_but_done(task: Task) -> None:
    progress = Progress(task)
    for stage in ("read", "write", "preview"):
        progress.reach(stage, 1.0)
    assert progress.percent >= 95.0
