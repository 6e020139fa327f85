from quadpatch_client.schema import TRANSITIONS, JobState


def test_every_state_has_its_row() -> None:
    assert set(TRANSITIONS) == set(JobState)


def test_a_job_can_always_reach_an_end() -> None:
    for state in JobState:
        reached, frontier = {state}, {state}
        while frontier:
            frontier = set().union(*(TRANSITIONS[s] for s in frontier)) - reached
            reached |= frontier
        assert any(s.is_terminal for s in reached)


def test_any_state_that_is_no_end_leads_to_canceled() -> None:
    for state in JobState:
        direct = TRANSITIONS[state]
        if not state.is_terminal:
            assert JobState.CANCELED in direct or JobState.CANCELING in direct


def test_the_four_ends_are_ends() -> None:
    ends = {state for state in JobState if state.is_terminal}
    assert ends == {JobState.CANCELED, JobState.SUCCEEDED, JobState.SUCCEEDED_WITH_WARNINGS, JobState.FAILED}
    assert {state for state in JobState if state.has_result} == {JobState.SUCCEEDED, JobState.SUCCEEDED_WITH_WARNINGS}
