"""The order in which tasks leave the queue."""

from contextlib import closing

from rq import Queue
from rq.serializers import JSONSerializer

from jobkit.queue import TaskQueue, job_entry, mesh_entry
from jobkit.settings import Settings


def test_analyses_and_jobs_that_lost_an_attempt_go_before_those_that_never_started(settings: Settings) -> None:
    with closing(TaskQueue(settings.redis_url.get_secret_value(), settings.queue_name, 60)) as queue:
        queue.enqueue_job("first", 1)
        queue.enqueue_job("second", 1)
        queue.enqueue_job("lost", 2)
        queue.enqueue_inspection("mesh", 1)
        entries = Queue(settings.queue_name, connection=queue.connection, serializer=JSONSerializer).get_job_ids()
    expected = [mesh_entry("mesh", 1), job_entry("lost", 2), job_entry("first", 1), job_entry("second", 1)]
    assert entries == expected
