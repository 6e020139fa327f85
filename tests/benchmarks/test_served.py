from collections import Counter

from benchmarks.served import N_RUNNING, furnish
from jobkit.database.session import Database
from jobkit.jobs.jobs import Jobs
from jobkit.settings import Settings
from quadpatch_client.schema import JobState


def test_one_job_in_four_has_ended_a_few_run_and_the_others_wait(settings: Settings, database: Database) -> None:
    n_jobs = 4 * (N_RUNNING + 1)
    ids, attempts = furnish(settings, n_jobs)
    states = Counter(Jobs(database).get(job_id).state for job_id in ids)
    n_ended = N_RUNNING + 1
    assert states == {
        JobState.SUCCEEDED: n_ended,
        JobState.RUNNING: N_RUNNING,
        JobState.QUEUED: n_jobs - n_ended - N_RUNNING,
    }
    assert [attempt.job_id for attempt in attempts] == ids[n_ended : n_ended + N_RUNNING]
