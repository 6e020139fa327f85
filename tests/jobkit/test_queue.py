"""The order in which tasks leave the queue."""

from contextlib import closing

from rq import Queue
from rq.serializers import JSONSerializer

from jobkit.queue import TaskQueue, job_entry, mesh_entry
from jobkit.settings import Settings


def test_tasks_stand_by_age_but_for_jobs_that_lost_an_attempt_or_wait_for_memory(settings: Settings) -> None:
    with closing(TaskQueue(settings.redis_url.get_secret_value(), settings.queue_name, 60)) as queue:
        queue.enqueue_job("first", 1)
        queue.enqueue_job("second", 1)
        queue.enqueue_job("lost", 2)
        queue.enqueue_inspection("mesh", 1)
        queue.enqueue_job("large", 1, at_front=True)
        entries = Queue(settings.queue_name, connection=queue.connection, serializer=JSONSerializer).get_job_ids()
    first = [job_entry("large", 1), job_entry("lost", 2)]
    assert entries == [*first, job_entry("first", 1), job_entry("second", 1), mesh_entry("mesh", 1)]
