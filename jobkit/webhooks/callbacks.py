"""Callback URLs: messages of the end of one job or batch, signed with one secret for each tenant.

The receiver of such a message often is another program than the one that started the job, and a message may arrive
before the answer that would bring a secret of its own. So all callbacks of a tenant are signed with one secret, which
receivers know beforehand, by the rules of subscriptions (`jobkit/webhooks/outbox.py`).

Tested in `tests/dispatcher/test_callbacks.py`.
"""

from collections.abc import Callable
from datetime import timedelta
from typing import Self

from sqlalchemy.orm import Session

from jobkit.database.clock import utc_now
from jobkit.database.idempotency import Idempotency, make_once
from jobkit.database.session import Database
from jobkit.database.tables import CallbackSecretRow
from jobkit.database.tenancy import DEFAULT_TENANT, tenant_of
from jobkit.errors import CallbackSecretMissingError
from jobkit.webhooks.subscriptions import OLD_SECRET_S, new_secret
from quadpatch_client.schema import CallbackSecret


class Callbacks:
    """What decides about callbacks of a tenant.

    Parameters
    ----------
    database : Database
    check_url : callable
        Raises where nothing may be sent to a URL.
    """

    def __init__(self, database: Database, check_url: Callable[[str], None]) -> None:
        self._database = database
        self._check_url = check_url

    def of(self, database: Database) -> Self:
        """Return the same for another view of the database."""
        return type(self)(database, self._check_url)

    def check(self, url: str | None) -> None:
        """Raise where no message can be sent to a callback URL; None is none.

        Raises
        ------
        CallbackSecretMissingError
            If the tenant has no secret yet.
        AddressRefusedError, TlsRequiredError, HostUnknownError
            If nothing may or can be sent there.
        """
        if url is None:
            return
        with self._database.read() as session:
            if _row(session) is None:
                raise CallbackSecretMissingError("make the secret that signs callbacks first: POST /v1/callback-secret")
        self._check_url(url)

    def renew_secret_once(self, idempotency: Idempotency | None) -> tuple[CallbackSecret, bool]:
        """Make a secret, unless the same request has; return it, and whether it is new.

        The one of before signs messages as well for OLD_SECRET_S seconds.

        Raises
        ------
        IdempotencyError
            If the key came before with another request.
        """
        return make_once(self._database, idempotency, _renew, lambda session, _: _show(session))


def _row(session: Session) -> CallbackSecretRow | None:
    return session.get(CallbackSecretRow, tenant_of(session) or DEFAULT_TENANT)


def _renew(session: Session) -> tuple[CallbackSecret, str]:
    row, now = _row(session), utc_now()
    if row is None:
        row = CallbackSecretRow(tenant=tenant_of(session) or DEFAULT_TENANT, secret=new_secret())
        session.add(row)
    else:
        row.old_secret, row.old_secret_until = row.secret, now + timedelta(seconds=OLD_SECRET_S)
        row.secret = new_secret()
    row.updated_at = now
    return CallbackSecret(secret=row.secret), "callback-secret"


def _show(session: Session) -> CallbackSecret:
    row = _row(session)
    if row is None:
        raise CallbackSecretMissingError("there is no secret for callbacks")
    return CallbackSecret(secret=row.secret)
