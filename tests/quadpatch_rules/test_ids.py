import re

from quadpatch_rules.ids import JOB_ID_PATTERN, new_job_id


def test_ids_follow_their_pattern_and_never_repeat() -> None:
    ids = [new_job_id() for _ in range(2000)]
    assert len(set(ids)) == 2000
    assert all(re.match(JOB_ID_PATTERN, job_id) for job_id in ids)


def test_ids_sort_by_age() -> None:
    """Only the milliseconds sort; within one, chance decides."""
    ids = [new_job_id()[:14] for _ in range(500)]
    assert ids == sorted(ids)
