"""The periodic task that follows batches."""

from collections.abc import Callable

from jobkit.batches.progress import note_progress
from jobkit.database.session import Database


def follow_batches(database: Database, is_over: Callable[[], bool]) -> str:
    """Cancel, count and end open batches; return words about it for the log."""
    n_ended = note_progress(database, is_over)
    return f"{n_ended} batches ended" if n_ended else ""
