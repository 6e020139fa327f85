"""Queue adapter: RQ as an executor only. The database is authoritative; a lost queue is refilled from it.

There is one queue for all kinds of tasks: RQ loses a job when a worker that listens to two queues is killed right
after the pop. All are ordered by age, since the length of an analysis is not known from the file; only jobs whose
attempt was lost, or that wait for memory, go to the front, since they have waited already, and views, which a person
waits for.
"""

import hashlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from redis import Redis
from redis.backoff import ConstantBackoff
from redis.exceptions import RedisError, ResponseError
from redis.retry import Retry
from rq import Queue, Worker
from rq.serializers import JSONSerializer

from jobkit.errors import QueueUnavailableError

RUN_JOB = "worker.jobs.run_job"
INSPECT_MESH = "worker.jobs.inspect_mesh"
PROVE_MODEL = "worker.jobs.prove_model"
MAKE_VIEW = "worker.jobs.make_view"
RUN_SHADOW = "worker.jobs.run_shadow"
# What a worker may be able to do that others are not: fit networks, which takes torch.
NETWORKS = "networks"
# Field of a worker's entry in Valkey; the entry expires with the worker.
_ABILITIES = "abilities"
# The engine has limits of its own; this one only frees a worker whose supervision of the engine failed.
_MARGIN_S = 60
_SOCKET_TIMEOUT_S = 5.0
_CONNECT_TIMEOUT_S = 2.0
# A connection that broke is made anew once. An unavailable server is not waited for: the database has the job.
_RETRIES = 1
_RETRY_PAUSE_S = 0.1


class TaskQueue:
    """The queue that API and workers share.

    Parameters
    ----------
    redis_url : str
    name : str
        Name of the RQ queue.
    time_limit_s : float
        Most seconds of one attempt; RQ's own limit lies a minute above.
    """

    def __init__(self, redis_url: str, name: str, time_limit_s: float) -> None:
        self.connection = Redis.from_url(
            redis_url,
            socket_timeout=_SOCKET_TIMEOUT_S,
            socket_connect_timeout=_CONNECT_TIMEOUT_S,
            retry=Retry(ConstantBackoff(_RETRY_PAUSE_S), _RETRIES),
        )
        self._queue = Queue(name, connection=self.connection, serializer=JSONSerializer)
        self._timeout_s = int(time_limit_s) + _MARGIN_S

    def enqueue_job(self, job_id: str, attempt: int, *, at_front: bool = False) -> None:
        """Ask for an attempt at a job; `attempt` is the number that it will have. Raise QueueUnavailableError."""
        self._enqueue(RUN_JOB, job_id, job_entry(job_id, attempt), at_front=attempt > 1 or at_front)

    def enqueue_jobs(self, jobs: Iterable[tuple[str, int]]) -> None:
        """Ask for an attempt at each of many jobs, in one exchange; raise QueueUnavailableError.

        Parameters
        ----------
        jobs : iterable of (str, int)
            The id of each, and the number that the attempt will have. Those that had one before go to the front.
        """
        with _translated():
            entries = [
                Queue.prepare_data(
                    RUN_JOB,
                    args=(job_id,),
                    timeout=self._timeout_s,
                    result_ttl=0,
                    failure_ttl=3600,
                    job_id=job_entry(job_id, attempt),
                    at_front=attempt > 1,
                )
                for job_id, attempt in jobs
            ]
            self._queue.enqueue_many(entries)

    def enqueue_inspection(self, mesh_id: str, attempt: int) -> None:
        """Ask for the analysis of a mesh; raise QueueUnavailableError."""
        self._enqueue(INSPECT_MESH, mesh_id, mesh_entry(mesh_id, attempt), at_front=False)

    def enqueue_proof(self, reference: str, attempt: int) -> None:
        """Ask for the proof of a model version, `name@version`; raise QueueUnavailableError."""
        self._enqueue(PROVE_MODEL, reference, model_entry(reference, attempt), at_front=False)

    def enqueue_view(self, view_id: str, attempt: int) -> None:
        """Ask for a view, in front of all that waits; raise QueueUnavailableError."""
        self._enqueue(MAKE_VIEW, view_id, view_entry(view_id, attempt), at_front=True)

    def enqueue_shadow(self, job_id: str, attempt: int) -> None:
        """Ask for the run of a candidate on a job, at the end of the queue; raise QueueUnavailableError."""
        self._enqueue(RUN_SHADOW, job_id, shadow_entry(job_id, attempt), at_front=False)

    def entries(self) -> set[str]:
        """Return the entries that wait in the queue; raise QueueUnavailableError."""
        with _translated():
            return set(self._queue.get_job_ids())

    def note_abilities(self, worker_key: str, abilities: Iterable[str]) -> None:
        """Write down what a worker can do, into the entry by which RQ knows it; raise QueueUnavailableError."""
        with _translated():
            self.connection.hset(worker_key, _ABILITIES, " ".join(abilities))

    def abilities(self) -> set[str]:
        """Return what running workers can do, all together; raise QueueUnavailableError."""
        with _translated():
            keys = Worker.all_keys(queue=self._queue)
            noted = [self.connection.hget(key, _ABILITIES) for key in keys]
        texts = [words.decode() if isinstance(words, bytes) else words for words in noted if words]
        return {word for text in texts for word in text.split()}

    def ping(self) -> None:
        """Raise QueueUnavailableError if Redis does not answer."""
        with _translated():
            self.connection.ping()

    def depth(self) -> int:
        """Return how many entries wait; raise QueueUnavailableError."""
        with _translated():
            return int(self._queue.count)

    def weaknesses(self) -> list[str] | None:
        """Tell in words how the server may lose entries; None where it does not say. Raise QueueUnavailableError.

        A lost queue loses no job, but until the dispatcher has noticed, jobs wait although workers are free.
        """
        with _translated():
            try:
                persistence, memory = self.connection.info("persistence"), self.connection.info("memory")
            except ResponseError:
                return None  # INFO may be forbidden, as on many managed servers
        keeps_log, policy = persistence.get("aof_enabled"), memory.get("maxmemory_policy")
        if keeps_log is None or policy is None:
            return None
        weak_points = [] if keeps_log else ["its append-only file is off"]
        return (
            weak_points if policy == "noeviction" else [*weak_points, f"maxmemory-policy is {policy}, not noeviction"]
        )

    def close(self) -> None:
        """Close all connections."""
        self.connection.close()

    def _enqueue(self, function: str, subject: str, entry: str, *, at_front: bool) -> None:
        with _translated():
            self._queue.enqueue_call(
                function,
                args=(subject,),
                timeout=self._timeout_s,
                result_ttl=0,
                failure_ttl=3600,
                job_id=entry,
                at_front=at_front,
            )


def job_entry(job_id: str, attempt: int) -> str:
    """Return the name of the queue's entry for that attempt at a job."""
    return f"{job_id}-{attempt}"


def mesh_entry(mesh_id: str, attempt: int) -> str:
    """Return the name of the queue's entry for that attempt at an analysis."""
    return f"mesh_{mesh_id}-{attempt}"


def shadow_entry(job_id: str, attempt: int) -> str:
    """Return the name of the queue's entry for that attempt at a run of a candidate."""
    return f"shadow_{job_id}-{attempt}"


def model_entry(reference: str, attempt: int) -> str:
    """Return the name of the queue's entry for that attempt at a proof.

    RQ takes letters, digits, underscores and dashes only; names of models hold dots as well.
    """
    return f"model_{hashlib.sha256(reference.encode()).hexdigest()[:32]}-{attempt}"


def view_entry(view_id: str, attempt: int) -> str:
    """Return the name of the queue's entry for that attempt at a view."""
    return f"view_{view_id}-{attempt}"


@contextmanager
def _translated() -> Iterator[None]:
    try:
        yield
    except (RedisError, OSError) as error:
        # The URL may hold a password, so the text of the error stays in the log.
        raise QueueUnavailableError("the queue does not answer") from error
