"""Registry of models: versions never change, aliases move.

Versions of a name count up from 1. The same bytes under the same name are the same version. Names and aliases share
one namespace, so a reference means one thing only. What clients publish is looked at here without opening it, and used
once a worker has proven it (`jobkit.models.proofs`).
"""

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Literal, cast

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from jobkit.database.clock import utc_now
from jobkit.database.quotas import admit_bytes
from jobkit.database.readable_rows import readable
from jobkit.database.session import Database
from jobkit.database.tables import AliasRow, DeletedModelRow, ModelRow
from jobkit.database.tenancy import names_of, own_name, shown_name, tenant_of
from jobkit.errors import ModelKindError, NameTakenError, RowConflictError
from jobkit.models.default_aliases import DEFAULT_KINDS
from jobkit.models.errors import ModelDeprecatedError
from jobkit.models.header import artifact_format, dictionary_card, to_wire_card
from jobkit.models.network_header import check_network, read_network_card
from jobkit.models.rows import (
    alias_row,
    check_proven,
    resolved_row,
    row_of_bytes,
    to_alias,
    to_model,
    to_version,
    version_row,
)
from jobkit.schema import SELF, Alias, Model, ModelKind, ModelList, ModelState, ModelVersion
from jobkit.storage.base import CHUNK_BYTES, ObjectStore, StoredObject
from jobkit.storage.removals import assure
from shared_rules.dictionary_file import Card

MODEL_PREFIX = "models"
# Of one name, published at the same moment.
_MOST_CONFLICTS = 20
# Of one model: when it is asked for, and in the list of all; a card has up to 64 KiB.
MOST_VERSIONS = 100
MOST_LISTED_VERSIONS = 20
RESERVED_NAMES = frozenset({SELF, "auto", "smooth", "none", "latest"})


@dataclass(frozen=True)
class Artifact:
    """Where the bytes of a model version lie."""

    key: str
    format: Literal["safetensors", "onnx"]
    sha256: str
    size_bytes: int
    deprecated_at: datetime | None = None


class Registry:
    """All models of a database, their artifacts in the store."""

    def __init__(self, database: Database, store: ObjectStore) -> None:
        self._database = database
        self._store = store

    def publish(
        self,
        name: str,
        stored: StoredObject,
        card: Card | None = None,
        version: int | None = None,
        *,
        is_proven: bool = False,
        shared: bool = False,
    ) -> tuple[ModelVersion, bool]:
        """Make bytes that lie in the store a version of a model; one that was refused is to be proven anew.

        Parameters
        ----------
        name : str
        stored : StoredObject
            Written with the prefix MODEL_PREFIX; if it is no model, it is left to the sweep, since another version
            may be made of the same bytes and a better card.
        card : dict, optional
            Of a network, in place of the one in its metadata; a dictionary always brings its own.
        version : int, optional
            Number to take; None: the next one.
        is_proven : bool
            Whether the bytes are trusted; otherwise a worker has to prove them.
        shared : bool
            Whether all tenants may use the version.

        Returns
        -------
        ModelVersion, bool
            The version, and whether it is new.

        Raises
        ------
        NameTakenError
            If an alias has that name, or the name is reserved, or the version number is taken.
        UnusableModelError
            If the bytes are no model.
        StorageQuotaError
            If the version is new, and the tenant would store more than it may.
        """
        assure(self._database, self._store, stored.key)
        kind, artifact, full_card = self._inspect(stored, card)
        wire_card = to_wire_card(full_card).model_dump(mode="json")
        row = ModelRow(
            name=own_name(self._database.tenant, name),
            shared=shared,
            kind=kind,
            format=artifact.format,
            sha256=stored.sha256,
            size_bytes=stored.size_bytes,
            key=stored.key,
            card=wire_card,
            state=(ModelState.READY if is_proven else ModelState.PROVING).value,
            attempt=0,
            forgiven=0,
            created_at=utc_now(),
        )
        for _ in range(_MOST_CONFLICTS):
            try:
                return self._insert(row, version)
            except RowConflictError:
                continue  # another version was published at the same moment: now the next number is another one
        return self._insert(row, version)

    def publish_file(
        self, name: str, path: Path, card: Card | None = None, version: int | None = None
    ) -> tuple[ModelVersion, bool]:
        """Store a local file that is trusted, and share it with all tenants; returns and raises as `publish`."""
        with path.open("rb") as source, self._store.writer(MODEL_PREFIX) as writer:
            while chunk := source.read(CHUNK_BYTES):
                writer.write(chunk)
            stored = writer.commit()
        return self.publish(name, stored, card, version, is_proven=True, shared=True)

    def resolve(self, reference: str) -> ModelVersion:
        """Return the version that `name@version`, `name` or an alias means now; raise ModelNotFoundError."""
        with self._database.read() as session:
            return to_version(session, resolved_row(session, reference))

    def usable(self, reference: str) -> ModelVersion:
        """Return the version that the reference means now, for a job.

        Raises
        ------
        ModelNotFoundError
            If it means nothing.
        ModelNotProvenError, ModelRefusedError
            If the version is not proven.
        """
        with self._database.read() as session:
            row = resolved_row(session, reference)
            check_proven(row)
            return to_version(session, row)

    def with_sha256(self, sha256: str, name: str) -> ModelVersion:
        """Return a version of these bytes, for a job; raises as `usable`. `name` is what they were called elsewhere."""
        with self._database.read() as session:
            row = row_of_bytes(session, sha256, name)
            check_proven(row)
            return to_version(session, row)

    def get(self, name: str, limit: int = MOST_VERSIONS, cursor: int | None = None) -> Model:
        """Return a model with its newest versions, of those below the `cursor`; raise ModelNotFoundError."""
        with self._database.read() as session:
            return to_model(session, name, limit, cursor)

    def artifact(self, name: str, version: int) -> Artifact:
        """Return where the bytes of a version lie; raise ModelNotFoundError."""
        with self._database.read() as session:
            row = version_row(session, name, version)
            form = cast('Literal["safetensors", "onnx"]', row.format)
            return Artifact(row.key, form, row.sha256, row.size_bytes, row.deprecated_at)

    def page(self, limit: int, cursor: str | None = None) -> ModelList:
        """Return models by name with their newest versions, and the aliases that point to them.

        Parameters
        ----------
        limit : int
            Most models on the page.
        cursor : str, optional
            `next_cursor` of the page before.
        """
        tenant = self._database.tenant
        shown = func.replace(ModelRow.name, own_name(tenant, ""), "") if own_name(tenant, "") else ModelRow.name
        query = select(shown).distinct().order_by(shown).limit(limit + 1)
        with self._database.read() as session:
            names = list(session.scalars(query if cursor is None else query.where(shown > cursor)))
            page_names = names[:limit]
            owned = [owned for name in page_names for owned in names_of(tenant, name)]
            aliases = session.scalars(select(AliasRow).where(AliasRow.name.in_(owned)).order_by(AliasRow.alias))
            return ModelList(
                models=list(readable(page_names, lambda name: to_model(session, name, MOST_LISTED_VERSIONS))),
                aliases=[to_alias(row) for row in aliases],
                next_cursor=page_names[-1] if len(names) > limit else None,
            )

    def has_kind(self, kind: ModelKind) -> bool:
        """Return whether any model of that kind is registered, refused ones left aside."""
        is_there = (ModelRow.kind == kind) & (ModelRow.state != ModelState.REFUSED.value)
        with self._database.read() as session:
            return session.scalars(select(ModelRow.name).where(is_there).limit(1)).first() is not None

    def set_alias(self, alias: str, reference: str) -> Alias:
        """Point an alias to the version that the reference means now; where all see the alias, they see that, too.

        Raises
        ------
        ModelNotFoundError
            If the reference means nothing.
        NameTakenError
            If a model has that name, or the name is reserved.
        ModelKindError
            If the alias means models of the other kind: specs that name it would break.
        ModelNotProvenError, ModelRefusedError, ModelDeprecatedError
            If the version is not to be used.
        """
        with self._database.write() as session:
            resolved = resolved_row(session, reference)
            # Locked: it may be deprecated or deleted at the same moment.
            target = version_row(session, resolved.name, resolved.version, lock=True)
            check_proven(target)
            if target.deprecated_at is not None:
                shown = f"{shown_name(target.name)}@{target.version}"
                raise ModelDeprecatedError(f"{shown} is deprecated; no alias may point to it")
            tenant = tenant_of(session)
            names = names_of(tenant, alias)
            if alias in RESERVED_NAMES or session.scalars(select(ModelRow).where(ModelRow.name.in_(names))).first():
                raise NameTakenError(f"{alias!r} is the name of a model, or reserved")
            own = own_name(tenant, alias)
            row = session.get(AliasRow, own, with_for_update=True) or AliasRow(alias=own, shared=False)
            if tenant is None:
                row.shared = True
            kind = _kind_of_alias(session, row)
            if kind not in (None, target.kind):
                raise ModelKindError(
                    f"{alias!r} means models of the kind {kind}; {reference} is of the kind {target.kind}"
                )
            row.name, row.version, row.updated_at = target.name, target.version, utc_now()
            # Jobs of all tenants mean a shared alias: they have to see what it points to.
            target.shared |= row.shared
            session.add(row)
            return to_alias(row)

    def _inspect(self, stored: StoredObject, card: Card | None) -> tuple[ModelKind, Artifact, Card]:
        with self._store.local_file(stored.key) as path:
            kind_of_file = artifact_format(path)
            artifact = Artifact(stored.key, kind_of_file, stored.sha256, stored.size_bytes)
            if kind_of_file == "onnx":
                check_network(path)
                return "autoencoder", artifact, card or read_network_card(path) or {}
            return "dictionary", artifact, dictionary_card(path)

    def _insert(self, row: ModelRow, version: int | None) -> tuple[ModelVersion, bool]:
        with self._database.write() as session:
            name = shown_name(row.name)
            if name in RESERVED_NAMES or alias_row(session, name) is not None:
                raise NameTakenError(f"{name!r} is an alias, or reserved")
            if row.name != name and session.scalars(select(ModelRow).where(ModelRow.name == name).limit(1)).first():
                raise NameTakenError(f"{name!r} is the name of a shared model; publish yours under another one")
            is_same = (ModelRow.name == row.name) & (ModelRow.sha256 == row.sha256)
            existing_row = session.scalars(select(ModelRow).where(is_same).with_for_update()).one_or_none()
            if existing_row is not None:
                _publish_again(existing_row, row)
                return to_version(session, existing_row), False
            new_version = _free_number(session, row.name, version)
            new_row = ModelRow(
                **{c.key: getattr(row, c.key) for c in ModelRow.__table__.columns} | {"version": new_version}
            )
            session.add(new_row)
            session.flush()
            admit_bytes(session, row.size_bytes)
            return to_version(session, new_row), True


def _kind_of_alias(session: Session, row: AliasRow) -> str | None:
    """Return the kind of model that an alias keeps to: that of its first target; None where it is free."""
    if row.name is None:
        return DEFAULT_KINDS.get(shown_name(row.alias))
    return version_row(session, row.name, row.version).kind


def _free_number(session: Session, name: str, requested_number: int | None) -> int:
    """Return the number for a new version; those of deleted versions never come back, since jobs name them."""
    if requested_number is not None and session.get(ModelRow, (name, requested_number)) is not None:
        raise NameTakenError(f"{shown_name(name)}@{requested_number} is taken by other bytes; versions never change")
    latest = session.scalar(select(func.max(ModelRow.version)).where(ModelRow.name == name)) or 0
    # Read last: a version that is deleted at this moment is seen among the rows above, or here.
    last_deleted = session.scalar(select(DeletedModelRow.version).where(DeletedModelRow.name == name)) or 0
    if requested_number is None:
        return max(latest, last_deleted) + 1
    if requested_number <= last_deleted:
        raise NameTakenError(f"{shown_name(name)}@{last_deleted} was deleted; no version up to it comes back")
    return requested_number


def _publish_again(row: ModelRow, new_row: ModelRow) -> None:
    """Let a version that was not usable be used, or be proven anew by the card that came now."""
    row.shared |= new_row.shared
    if row.state == ModelState.READY.value:
        return
    if new_row.state == ModelState.READY.value or row.state == ModelState.REFUSED.value:
        row.state, row.card, row.problem = new_row.state, new_row.card, None
        row.lease_until = row.enqueued_at = None
        # As many tries as a new one; one that is under way may write no more.
        row.attempt += 1
        row.forgiven = row.attempt
