"""How much memory jobs are expected to need: their peaks, in MiB of the engine's resident set.

Past jobs tell it where enough of them are similar (`jobkit.jobs.past_jobs`): nine of ten needed no more for each byte,
beyond what an engine needs that has read nothing. Else a formula goes by the bytes of the file. It lies above the peaks
of binary PLY files with 20 holes, see `docs/decisions/0031-jobs-wait-for-memory.md`; thousands of holes need more.
"""

import math
import threading
import time
from collections.abc import Callable, Sequence

from jobkit.database.session import Database
from jobkit.jobs.past_jobs import PastJob, Rates, Sample, kind_of, read_past
from quadpatch_rules.tasks import FILL, TRAIN

# A fill by geometry alone, and kinds that are as frugal, or that fit a network.
BY_GEOMETRY = kind_of(FILL, "none")
_BY_GEOMETRY = (BY_GEOMETRY, kind_of(FILL, "auto", "fast"))
_FITTING = (kind_of(FILL, "self_network"), kind_of(FILL, "auto", "best"), kind_of(TRAIN, "self_network"))
# Of an engine that has read nothing.
BASE_MB = 80
_MIB = 1 << 20
_REFRESH_S = 60.0
# Of geometry and a picture.
_GEOMETRY_MB, _GEOMETRY_PER_MB = 140, 16
# Of patches besides; those of fills are cut from a coarse copy where the mesh is large.
_PATCHES_MB, _PATCHES_PER_MB, _PATCHES_OF_FILL_MOST_MB = 60, 80, 800
# Of a second process, which shares fills from this size on (`quadpatch.processes.LEAST_BYTES`).
_SHARED_BYTES, _HELPER_MB = 1_000_000, 80
# Of the patches of all meshes of a training (`training.requested.MOST_VALUES`), and of what K-SVD makes of them.
_TRAINING, _TRAINING_MB = kind_of(TRAIN, "none"), 450
# Of torch besides, to fit a network to the mesh.
_FITTING_MB = 500


class MemoryNeeds:
    """What jobs of a database are expected to need; past jobs are read by `refresh` alone.

    Parameters
    ----------
    database : Database
    clock : callable
        Seconds that never go back.
    """

    def __init__(self, database: Database, clock: Callable[[], float] = time.monotonic) -> None:
        self._database = database
        self._clock = clock
        self._lock = threading.Lock()
        self._refresh_at = -math.inf
        self._rates = Rates(())

    def refresh(self) -> None:
        """Read past jobs again if that was last done over a minute ago."""
        with self._lock:
            if self._clock() < self._refresh_at:
                return
            with self._database.read() as session:
                past = read_past(session)
            self._rates = Rates((s for job in past if (s := _sample(job)) is not None), _nine_of_ten)
            self._refresh_at = self._clock() + _REFRESH_S

    def expected_mb(self, kind: str, size_bytes: int) -> int:
        """Return the expected peak.

        Parameters
        ----------
        kind : str
            Task, kind of the model and effort, as `jobkit.jobs.past_jobs.kind_of` has it.
        size_bytes : int
            Of the mesh.
        """
        beyond_base_mb = self._rates.amount(kind, size_bytes)
        if beyond_base_mb is not None:
            return BASE_MB + math.ceil(beyond_base_mb)
        return expected_from_bytes(kind, size_bytes)


def expected_from_bytes(kind: str, size_bytes: int) -> int:
    """Return the expected peak of a job without similar past ones, in MiB; parameters as above."""
    size_mb = size_bytes / _MIB
    needed_mb = _GEOMETRY_MB + _GEOMETRY_PER_MB * size_mb
    if kind not in _BY_GEOMETRY:
        most_mb = _PATCHES_OF_FILL_MOST_MB if kind.startswith(f"{FILL} ") else math.inf
        needed_mb += _PATCHES_MB + min(_PATCHES_PER_MB * size_mb, most_mb)
    if size_bytes >= _SHARED_BYTES:
        needed_mb += _HELPER_MB
    if kind in _FITTING:
        needed_mb += _FITTING_MB
    if kind == _TRAINING:
        needed_mb += _TRAINING_MB
    return math.ceil(needed_mb)


def _sample(job: PastJob) -> Sample | None:
    if job.peak_memory_mb is None:
        return None
    return Sample(job.kind, job.size_bytes, max(job.peak_memory_mb - BASE_MB, 0))


def _nine_of_ten(values: Sequence[float]) -> float:
    return sorted(values)[math.ceil(0.9 * len(values)) - 1]
