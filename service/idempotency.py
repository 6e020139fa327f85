"""The header `Idempotency-Key`, and what tells a repeated request from another one under the same key."""

import hashlib

from starlette.responses import Response

from jobkit.database.idempotency import Idempotency


def idempotency_of(principal: str, key: str | None, *request: str) -> Idempotency | None:
    """Return the key with a digest of the request, None where none was sent.

    Parameters
    ----------
    principal : str
    key : str, optional
    request : str
        What the request asks for: its operation, and everything that it says.
    """
    if key is None:
        return None
    return Idempotency(principal, key, hashlib.sha256("\n".join(request).encode()).hexdigest())


def note_replayed(response: Response, *, is_new: bool) -> Response:
    """Say in the response that an earlier request with the same key has brought it about."""
    if not is_new:
        response.headers["Idempotent-Replayed"] = "true"
    return response
