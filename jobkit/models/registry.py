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

from jobkit.database.clock import utc_now
from jobkit.database.quotas import admit_bytes
from jobkit.database.readable_rows import readable
from jobkit.database.session import Database
from jobkit.database.tables import AliasRow, ModelRow
from jobkit.database.tenancy import names_of, own_name
from jobkit.errors import RowConflictError
from jobkit.models.aliases import point_alias
from jobkit.models.header import artifact_format, dictionary_card, to_wire_card
from jobkit.models.network_header import check_network, read_network_card
from jobkit.models.publication import insert_version
from jobkit.models.rows import (
    check_proven,
    resolved_row,
    row_of_bytes,
    to_alias,
    to_model,
    to_version,
    version_row,
)
from jobkit.storage.base import CHUNK_BYTES, ObjectStore, StoredObject
from jobkit.storage.removals import assure
from quadpatch_client.schema import Alias, Model, ModelKind, ModelList, ModelState, ModelVersion
from quadpatch_rules.dictionary_file import Card

MODEL_PREFIX = "models"
# Of one name, published at the same moment.
MOST_CONFLICTS = 20
# Of one model: when it is asked for, and in the list of all; a card has up to 64 KiB.
MOST_VERSIONS = 100
MOST_LISTED_VERSIONS = 20


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
        row = self.prepared(name, stored, card, is_proven=is_proven, shared=shared)
        for _ in range(MOST_CONFLICTS):
            try:
                return self._insert(row, version)
            except RowConflictError:
                continue  # another version was published at the same moment: now the next number is another one
        return self._insert(row, version)

    def prepared(
        self,
        name: str,
        stored: StoredObject,
        card: Card | None = None,
        *,
        is_proven: bool = False,
        shared: bool = False,
    ) -> ModelRow:
        """Return the row of a version that `insert_version` is yet to number; parameters and errors as of `publish`."""
        assure(self._database, self._store, stored.key)
        kind, artifact, full_card = self._inspect(stored, card)
        return ModelRow(
            name=own_name(self._database.tenant, name),
            shared=shared,
            kind=kind,
            format=artifact.format,
            sha256=stored.sha256,
            size_bytes=stored.size_bytes,
            key=stored.key,
            card=to_wire_card(full_card).model_dump(mode="json"),
            state=(ModelState.READY if is_proven else ModelState.PROVING).value,
            attempt=0,
            forgiven=0,
            created_at=utc_now(),
        )

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
            return point_alias(session, alias, reference)

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
            new_row, is_new = insert_version(session, row, version)
            if is_new:
                session.flush()
                admit_bytes(session, row.size_bytes)
            return to_version(session, new_row), is_new
