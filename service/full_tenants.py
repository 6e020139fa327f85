"""Jobs of tenants that store what they may are refused: there would be no place for their results.

How large a result becomes is not known, so this need not be exact to the byte, as what is stored is. That a tenant has
room is known for five seconds: a batch of thousands of jobs is not to count all files of its tenant for each of them.

Tested in `tests/service/routes/test_tenants.py`.
"""

import threading

from cachetools import TTLCache

from jobkit.database.quotas import check_bytes
from jobkit.database.session import Database

_KNOWN_FOR_S = 5.0
_MOST_KNOWN = 10_000


class FullTenants:
    """Tells tenants that store what they may."""

    def __init__(self) -> None:
        self._have_room: TTLCache[str | None, bool] = TTLCache(_MOST_KNOWN, _KNOWN_FOR_S)
        self._lock = threading.Lock()

    def check(self, database: Database) -> None:
        """Raise StorageQuotaError where the tenant of a database has no room for a byte more."""
        with self._lock:
            if self._have_room.get(database.tenant):
                return
        with database.read() as session:
            check_bytes(session, 1)
        with self._lock:
            self._have_room[database.tenant] = True
