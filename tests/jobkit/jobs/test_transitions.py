import pytest

from jobkit.jobs.transitions import Transition
from quadpatch_client.schema import TRANSITIONS, JobState


@pytest.mark.parametrize("source", JobState)
@pytest.mark.parametrize("target", JobState)
def test_only_the_drawn_steps_can_be_made(source: JobState, target: JobState) -> None:
    if target in TRANSITIONS[source]:
        Transition(source, target, "started")
    else:
        with pytest.raises(ValueError, match="never"):
            Transition(source, target, "started")
