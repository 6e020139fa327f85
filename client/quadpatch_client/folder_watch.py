"""A folder that a scanning station drops files into: each is repaired, and what comes back appears beside it.

A file is taken once it has not changed for a while. What has come of it stands in a journal on the disk. While the
service is away files wait where they are, and nothing is forgotten when the client is killed: it looks at the folder
again. A file that can't be repaired is moved into a folder of its own, with the reason beside it.

Tested in `tests/quadpatch_client/test_folder_watch.py`.
"""

import time
from collections.abc import Callable
from concurrent.futures import Future, wait
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from quadpatch_client.errors import (
    AnswerError,
    ClientError,
    DamagedTransferError,
    JobFailedError,
    RefusedError,
    UnreachableError,
)
from quadpatch_client.file_repair import FilePlan, JobOptions, Row, failure, repair_file
from quadpatch_client.folder_files import mesh_files, passed_over, passed_over_in_words
from quadpatch_client.journal import DONE, Entry, Journal, Stamp, sync
from quadpatch_client.rejected_files import set_aside
from quadpatch_client.workers import Workers

if TYPE_CHECKING:
    from quadpatch_client.sdk import Client

STATE = ".quadpatch"
FAILED = "failed"
REPAIRED = "-repaired"
_FIRST_PAUSE_S, _LONGEST_PAUSE_S = 1.0, 60.0
# Of a job that failed for a reason that may pass.
_MOST_TRIES = 3
# What the service may refuse because of the file. All else lies with the key, the options or the load: files wait then.
_OF_THE_FILE = frozenset({"body_too_large", "mesh_rejected", "mesh_encoded", "unsupported_media_type"})


@dataclass
class _Waiting:
    """A file that was seen: since when it has had these bytes, and when it may be tried again, by the clock."""

    stamp: Stamp
    since: float
    not_before: float = 0.0
    n_tries: int = 0


class FolderWatch:
    """One folder.

    Parameters
    ----------
    client : Client
    folder : Path
    options : JobOptions
    journal : Journal
    n_parallel : int
        Files at a time.
    settle_s : float
        How long a file has to stay as it is before it is taken, in seconds.
    tell : callable
        Gets lines for people: what came of a file, and what is in the way.
    with_html : bool
        Whether the report comes as a page, too.
    is_patient : bool
        Whether files wait while the service refuses the key or the options, and with them every file; else that is
        raised.
    clock : callable
        Seconds that only grow.
    """

    def __init__(  # noqa: PLR0913, PLR0917 - what a station may choose
        self,
        client: "Client",
        folder: Path,
        options: JobOptions,
        journal: Journal,
        n_parallel: int,
        settle_s: float,
        tell: Callable[[str], None],
        with_html: bool = False,
        is_patient: bool = True,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._client, self._folder, self._options, self._journal = client, folder, options, journal
        self._settle_s, self._tell, self._with_html, self._clock = settle_s, tell, with_html, clock
        self._is_patient = is_patient
        self._workers = Workers(n_parallel)
        self._n_parallel = n_parallel
        self._seen: dict[Path, _Waiting] = {}
        self._busy: dict[Path, Future[Row]] = {}
        self._pause_s = 0.0
        self._others: dict[Path, float] = {}
        self._told = set[Path]()

    @property
    def is_idle(self) -> bool:
        """Whether no file waits, and none is under way; an empty one is still to be written."""
        return not any(waiting.stamp.size for waiting in self._seen.values())

    def look(self) -> None:
        """Look at the folder once: take what has become whole, and tell what has come of the others.

        Raises
        ------
        RefusedError
            If every file would be refused, and that is not waited for.
        """
        for path in [path for path, future in self._busy.items() if future.done()]:
            self._end(path, self._busy.pop(path))
        self._note_files()
        self._note_others()
        ready = [(p, waiting) for p, waiting in self._seen.items() if p not in self._busy and self._is_whole(waiting)]
        for path, waiting in ready[: self._n_parallel - len(self._busy)]:
            self._busy[path] = self._workers.submit(partial(self._repair, path, waiting.stamp))

    def _note_files(self) -> None:
        found = [path for path in mesh_files(self._folder, False) if not path.stem.endswith(REPAIRED)]
        for path in found:
            try:
                stamp = Stamp.of(path)
            except OSError:
                continue  # taken away meanwhile
            entry = self._journal.entries.get(path.name)
            is_over = entry is not None and entry.stamp == stamp and entry.state in (*DONE, "skipped")
            if path in self._busy or is_over:
                continue
            waiting = self._seen.get(path)
            if waiting is None or waiting.stamp != stamp:
                self._seen[path] = _Waiting(stamp, self._clock())
        for path in self._seen.keys() - set(found) - self._busy.keys():
            del self._seen[path]

    def _note_others(self) -> None:
        """Say once of each file that lies there and is no mesh by its name that it is passed over.

        What is renamed at its end, such as a file that a station still writes, is not told.
        """
        now = self._clock()
        found = passed_over(self._folder, False)
        lying = {self._folder / name: why for why, names in found.items() for name in names}
        self._others = {path: self._others.get(path, now) for path in lying if not is_own(path)}
        new = [path for path, since in self._others.items() if now - since >= self._settle_s and path not in self._told]
        self._told.update(new)
        told: dict[str, list[str]] = {}
        for path in new:
            told.setdefault(lying[path], []).append(path.name)
        if told:
            self._tell(f"passed over: {passed_over_in_words(told)}")

    def _is_whole(self, waiting: _Waiting) -> bool:
        now = self._clock()
        return waiting.stamp.size > 0 and now - waiting.since >= self._settle_s and now >= waiting.not_before

    def _repair(self, path: Path, stamp: Stamp) -> Row:
        """Repair a file, and return what came of it; it runs in a thread of its own."""
        plan = plan_beside(path, self._with_html)
        # What the station has written has to be there after a power cut, if the journal says that it is known.
        sync(path)
        sync(self._folder)
        row = repair_file(
            self._client, plan, self._options, lambda job: self._note(stamp, Row(plan.name, "started", job=job))
        )
        for output in plan.outputs():
            sync(output)
        sync(self._folder)
        if Stamp.of(path) == stamp:
            self._note(stamp, row)
        return row

    def _note(self, stamp: Stamp, row: Row) -> None:
        self._journal.write(Entry(row.file, row.state, stamp, facts=row.facts()))

    def _end(self, path: Path, future: "Future[Row]") -> None:
        waiting = self._seen[path]
        error = future.exception()
        if error is None:
            row = future.result()
            self._pause_s = 0.0
            del self._seen[path]
            self._tell(_told(row))
        elif isinstance(error, FileNotFoundError):
            del self._seen[path]
        elif self._is_final(error):
            # No connection is closed under other files at work.
            wait(self._busy.values())
            raise error
        elif not isinstance(error, ClientError | OSError):
            raise error
        elif self._may_pass(error, waiting):
            self._wait_for(path, waiting, error)
        else:
            self._set_aside(path, waiting, error)

    def _is_final(self, error: BaseException) -> bool:
        return not self._is_patient and isinstance(error, RefusedError) and error.concerns_every_file

    def _may_pass(self, error: ClientError | OSError, waiting: _Waiting) -> bool:
        """Tell whether the same file may be repaired another time."""
        if isinstance(error, UnreachableError | AnswerError | DamagedTransferError | OSError):
            return True
        if isinstance(error, RefusedError):
            return error.problem.code not in _OF_THE_FILE
        waiting.n_tries += 1
        retryable = isinstance(error, JobFailedError) and error.job.error is not None and error.job.error.retryable
        return retryable and waiting.n_tries < _MOST_TRIES

    def _wait_for(self, path: Path, waiting: _Waiting, error: Exception) -> None:
        self._pause_s = min(max(2 * self._pause_s, _FIRST_PAUSE_S), _LONGEST_PAUSE_S)
        waiting.not_before = self._clock() + self._pause_s
        n_waiting = len(self._seen)
        self._tell(f"{path.name} waits, {n_waiting} in all: {error}; next try in {self._pause_s:g} s")

    def _set_aside(self, path: Path, waiting: _Waiting, error: ClientError | OSError) -> None:
        row = failure(path.name, error)
        moved = set_aside(path, self._folder / FAILED, row)
        del self._seen[path]
        self._note(waiting.stamp, row)
        self._tell(f"{path.name} can't be repaired and was moved to {moved}: {error}")


def is_own(path: Path) -> bool:
    """Whether a file was made by this client: what came back, or is still on its way."""
    return path.stem.endswith(REPAIRED) or (path.name.startswith(".") and path.suffix == ".part")


def plan_beside(path: Path, with_html: bool) -> FilePlan:
    """Return where what is made of a file goes: `scan.ply` to `scan-repaired.ply` and `scan-repaired.json`."""
    suffix = ".glb" if path.suffix.lower() == ".gltf" else path.suffix
    output = path.with_name(f"{path.stem}{REPAIRED}{suffix}")
    html = output.with_suffix(".html") if with_html else None
    return FilePlan(path.name, path, output, output.with_suffix(".json"), html)


def _told(row: Row) -> str:
    from quadpatch_client.batch_summary import row_text  # noqa: PLC0415  loads tables

    return row_text(row)
