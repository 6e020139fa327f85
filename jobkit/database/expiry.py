"""When something is removed unless it is kept."""

from datetime import datetime, timedelta


def expiry(since: datetime | None, days: float, is_pinned: bool) -> datetime | None:
    """Return when something expires; None where it is kept.

    Parameters
    ----------
    since : datetime, optional
        When it came out of use; None: it is in use.
    days : float
        How long it is kept after that; 0: for ever.
    is_pinned : bool
        Whether it is to be kept.
    """
    if since is None or days == 0 or is_pinned:
        return None
    return since + timedelta(days=days)
