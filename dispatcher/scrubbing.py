"""The periodic task that reads all stored objects, a little at a time, and checks that they are what was stored."""

from collections.abc import Callable

from dispatcher.scrub import Scrub, ScrubLimits
from jobkit.database.session import Database
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore

_MB = 1 << 20


class Scrubbing:
    """The periodic task.

    Parameters
    ----------
    settings : Settings
    database : Database
    store : ObjectStore
    """

    def __init__(self, settings: Settings, database: Database, store: ObjectStore) -> None:
        self._scrub = Scrub(database, store, ScrubLimits(settings.scrub_days, settings.scrub_mb_s * _MB))

    def round(self, is_over: Callable[[], bool]) -> str:
        """Read what is due; return in words what was read."""
        found = self._scrub.round(is_over)
        if not found.objects:
            return ""
        return f"checked {found.objects} objects, {found.size_bytes} bytes; {found.damaged} more are damaged"
