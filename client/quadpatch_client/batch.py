"""All meshes of a folder, several at a time. It may be killed at any moment: the same command goes on where it was.

Every file is one job, whose request follows from the file and the options, so that it is found again and not started
twice. What has come of a file stands in the journal once all its results are on the disk.

Tested in `tests/integration/test_batch.py`.
"""

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from functools import partial
from typing import TYPE_CHECKING

from quadpatch_client.errors import ClientError, RefusedError, UnreachableError
from quadpatch_client.file_repair import FilePlan, JobOptions, Row, failure, repair_file
from quadpatch_client.journal import DONE, Entry, Journal, Stamp, sync
from quadpatch_client.workers import Workers

if TYPE_CHECKING:
    from quadpatch_client.sdk import Client

JOURNAL = "journal.jsonl"


class Batch:
    """The files of one batch.

    Parameters
    ----------
    client : Client
    plans : list of FilePlan
    options : JobOptions
    journal : Journal
    n_parallel : int
        Files at a time.
    """

    def __init__(
        self, client: "Client", plans: Sequence[FilePlan], options: JobOptions, journal: Journal, n_parallel: int
    ) -> None:
        self._client, self._options, self._journal = client, options, journal
        self._digest = options.digest()
        self._n_parallel = n_parallel
        self.plans = plans

    def finished(self) -> dict[str, Row]:
        """Return the rows of those files that an earlier run has finished with the same options."""
        found = {}
        for plan in self.plans:
            entry = self._journal.entries.get(plan.name)
            if entry is not None and self._holds(entry, plan):
                found[plan.name] = Row(plan.name, entry.state, **entry.facts)
        return found

    def run(self, tell: Callable[[Row], None]) -> list[Row]:
        """Repair what is left, and return the rows of all files in their order.

        Parameters
        ----------
        tell : callable
            Gets each row once it is known.

        Raises
        ------
        UnreachableError
            If the service does not answer. Nothing is lost: the same batch goes on later.
        RefusedError
            If the service refuses the key or the options, and with them every file.
        """
        rows = self.finished()
        workers = Workers(self._n_parallel)
        left = {workers.submit(partial(self._repair, plan)) for plan in self.plans if plan.name not in rows}
        workers.close()
        try:
            while left:
                ended, left = wait(left, return_when=FIRST_COMPLETED)
                for future in ended:
                    row = future.result()
                    rows[row.file] = row
                    tell(row)
        except RefusedError:
            _cancel(left)
            # Files at work are refused as well, or come to their end: no connection is closed under them.
            wait(left)
            raise
        finally:
            _cancel(left)
        return [rows[plan.name] for plan in self.plans]

    def _holds(self, entry: Entry, plan: FilePlan) -> bool:
        """Tell whether an entry is of these bytes and options, and what was made is still there."""
        if entry.options != self._digest or entry.stamp != Stamp.of(plan.source):
            return False
        return entry.state == "skipped" or (entry.state in DONE and plan.output.exists())

    def _repair(self, plan: FilePlan) -> Row:
        stamp = Stamp.of(plan.source)

        def note(row: Row) -> None:
            self._journal.write(Entry(plan.name, row.state, stamp, self._digest, row.facts()))

        try:
            plan.output.parent.mkdir(parents=True, exist_ok=True)
            row = repair_file(self._client, plan, self._options, lambda job: note(Row(plan.name, "started", job=job)))
            _sync_outputs(plan)
        except UnreachableError:
            raise
        except (ClientError, OSError) as error:
            if isinstance(error, RefusedError) and error.concerns_every_file:
                raise
            row = failure(plan.name, error)
        note(row)
        return row


def _cancel(futures: Iterable[Future[Row]]) -> None:
    for future in futures:
        future.cancel()


def _sync_outputs(plan: FilePlan) -> None:
    for path in plan.outputs():
        sync(path)
    sync(plan.output.parent)
