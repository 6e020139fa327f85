"""Keys of clients: made, rotated and revoked; the database holds digests of them alone.

A key has 256 random bits, so a plain sha256 is enough: there is nothing to guess, and nothing to slow down.

Tested in `tests/service/routes/test_keys.py`.
"""

import hashlib
import secrets
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import exists, or_, select, update
from sqlalchemy.orm import Session

from jobkit.database.access_tables import KeyRow
from jobkit.database.clock import shared_now, utc_now
from jobkit.database.idempotency import Idempotency, make_once
from jobkit.database.quotas import note_tenant
from jobkit.database.readable_rows import readable
from jobkit.database.session import Database
from jobkit.database.tenancy import DEFAULT_TENANT, tenant_of
from jobkit.errors import KeyNotFoundError, KeyRevokedError
from quadpatch_client.schema import Key, KeyChanges, KeyList, KeyWithSecret, NewKey, Scope
from quadpatch_rules.ids import new_key_id

PREFIX = "qpk_"
# Of the ids of those who come with a token in place of a key.
TOKEN_PREFIX = "oidc-"
# How long the key of before is taken after a rotation: stations are given the new one meanwhile.
OLD_KEY_FOR = timedelta(days=1)
# `used_at` is written at most so often.
_USE_NOTED_EVERY = timedelta(minutes=1)


@dataclass(frozen=True)
class Holder:
    """Who holds a key, and what that allows; of requests within a minute 0 is no limit of its own."""

    key_id: str
    name: str
    tenant: str
    scopes: frozenset[Scope]
    requests_per_minute: int = 0

    @property
    def public_name(self) -> str | None:
        """What reports call the holder: the key by its name, a token by its digest; None where no key was needed."""
        return self.key_id if self.key_id.startswith(TOKEN_PREFIX) else self.name or None


class Keys:
    """The keys of a database; through that of a tenant, the tenant's own."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def create(self, new: NewKey, idempotency: Idempotency | None = None) -> tuple[KeyWithSecret, bool]:
        """Make a key, unless the same request has; return it, and whether it is new.

        Where an earlier request with the same idempotency key made it, `key` is empty: it can't be shown again.

        Raises
        ------
        IdempotencyError
            If the idempotency key came before with another request.
        """
        return make_once(self._database, idempotency, lambda session: _create(session, new), _shown_without_key)

    def list_all(self) -> KeyList:
        """Return all keys, oldest first."""
        with self._database.read() as session:
            return KeyList(items=list(readable(session.scalars(select(KeyRow).order_by(KeyRow.id)), _shown)))

    def get(self, key_id: str) -> Key:
        """Return a key; raise KeyNotFoundError."""
        with self._database.read() as session:
            return _shown(_existing(session, key_id))

    def change(self, key_id: str, changes: KeyChanges) -> Key:
        """Change a key; raise KeyNotFoundError."""
        with self._database.write() as session:
            row = _existing(session, key_id, locked=True)
            for name in changes.model_fields_set:
                setattr(row, name, getattr(changes, name))
            session.flush()
            return _shown(row)

    def rotate(self, key_id: str, idempotency: Idempotency | None = None) -> tuple[KeyWithSecret, bool]:
        """Give a new key in place of one, which is taken as well for a day; return it, and whether it is new.

        Where an earlier request with the same idempotency key made it, `key` is empty.

        Raises
        ------
        KeyNotFoundError
            If there is none.
        KeyRevokedError
            If it was revoked.
        IdempotencyError
            If the idempotency key came before with another request.
        """
        return make_once(self._database, idempotency, lambda session: _rotate(session, key_id), _shown_without_key)

    def revoke(self, key_id: str) -> None:
        """Take a key no more, nor the one of before; a second time changes nothing. Raise KeyNotFoundError."""
        with self._database.write() as session:
            row = _existing(session, key_id, locked=True)
            row.revoked_at = row.revoked_at or utc_now()

    def are_there(self) -> bool:
        """Tell whether any key was ever made; requests without one are refused then."""
        with self._database.read() as session:
            return bool(session.scalar(select(exists().where(KeyRow.id.is_not(None)))))

    def holder(self, sha256: str) -> Holder | None:
        """Return who holds the key with this digest, None where it is not taken; note that it is used."""
        with self._database.read() as session:
            now = shared_now(session)
            is_it = or_(KeyRow.sha256 == sha256, (KeyRow.old_sha256 == sha256) & (KeyRow.old_until > now))
            is_taken = KeyRow.revoked_at.is_(None) & or_(KeyRow.expires_at.is_(None), KeyRow.expires_at > now)
            row = session.scalars(select(KeyRow).where(is_it, is_taken)).first()
        if row is None:
            return None
        if row.used_at is None or row.used_at < now - _USE_NOTED_EVERY:
            with self._database.write() as session:
                session.execute(update(KeyRow).where(KeyRow.id == row.id).values(used_at=now))
        known = {scope.value for scope in Scope}
        scopes = frozenset(Scope(s) for s in row.scopes if s in known)
        return Holder(row.id, row.name, row.tenant, scopes, row.requests_per_minute or 0)


def digest_of(key: str) -> str:
    """Return what is stored of a key."""
    return hashlib.sha256(key.encode("utf-8", "surrogateescape")).hexdigest()


def _new_key() -> str:
    return PREFIX + secrets.token_urlsafe(32)


def _create(session: Session, new: NewKey) -> tuple[KeyWithSecret, str]:
    key = _new_key()
    row = KeyRow(
        id=new_key_id(),
        name=new.name,
        tenant=new.tenant or tenant_of(session) or DEFAULT_TENANT,
        scopes=[scope.value for scope in new.scopes],
        requests_per_minute=new.requests_per_minute,
        sha256=digest_of(key),
        expires_at=new.expires_at,
        created_at=utc_now(),
    )
    session.add(row)
    note_tenant(session, row.tenant)
    session.flush()
    return _with_key(row, key), row.id


def _rotate(session: Session, key_id: str) -> tuple[KeyWithSecret, str]:
    row = _existing(session, key_id, locked=True)
    if row.revoked_at is not None:
        raise KeyRevokedError(f"key {key_id} was revoked; make another one")
    key = _new_key()
    row.old_sha256, row.old_until = row.sha256, shared_now(session) + OLD_KEY_FOR
    row.sha256 = digest_of(key)
    session.flush()
    return _with_key(row, key), row.id


def _existing(session: Session, key_id: str, *, locked: bool = False) -> KeyRow:
    row = session.get(KeyRow, key_id, populate_existing=locked, with_for_update=locked or None)
    if row is None:
        raise KeyNotFoundError(f"there is no key {key_id}")
    return row


def _shown(row: KeyRow) -> Key:
    return Key.model_validate(_wire(row))


def _with_key(row: KeyRow, key: str) -> KeyWithSecret:
    return KeyWithSecret.model_validate({**_wire(row), "key": key})


def _shown_without_key(session: Session, key_id: str) -> KeyWithSecret:
    return _with_key(_existing(session, key_id), "")


def _wire(row: KeyRow) -> dict[str, Any]:
    old_until: datetime | None = row.old_until if row.old_until and row.old_until > utc_now() else None
    return {name: getattr(row, name) for name in Key.model_fields.keys() - {"old_until"}} | {"old_until": old_until}
