"""Registry of models: versions never change, aliases move.

Versions of a name count up from 1. The same bytes under the same name are the same version. Names and aliases share
one namespace, so a reference means one thing only.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal, cast

from sqlalchemy import func, select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from jobkit.clock import utc_now
from jobkit.database import Database
from jobkit.errors import ModelKindError, ModelNotFoundError, NameTakenError
from jobkit.model_header import Card, artifact_format, read_dictionary_card, to_wire_card
from jobkit.network_header import check_network, read_network_card
from jobkit.readable import readable
from jobkit.removals import assure
from jobkit.schema import SELF, Alias, Model, ModelKind, ModelLinks, ModelList, ModelVersion
from jobkit.store import CHUNK_BYTES, ObjectStore, StoredObject
from jobkit.tables import AliasRow, ModelRow

MODEL_PREFIX = "models"
# Of one name, published at the same moment.
_MOST_RIVALS = 20
# What specs mean that name no model.
DEFAULT_KINDS: dict[str, ModelKind] = {"default": "dictionary", "default-network": "autoencoder"}
RESERVED_NAMES = frozenset({SELF, "smooth", "none", "latest"})


@dataclass(frozen=True)
class Artifact:
    """Where the bytes of a model version lie."""

    key: str
    format: Literal["safetensors", "onnx"]
    sha256: str
    size_bytes: int


class Registry:
    """All models of a database, their artifacts in the store."""

    def __init__(self, database: Database, store: ObjectStore) -> None:
        self._database = database
        self._store = store

    def publish(
        self, name: str, stored: StoredObject, card: Card | None = None, version: int | None = None
    ) -> tuple[ModelVersion, bool]:
        """Make bytes that lie in the store a version of a model.

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
        """
        assure(self._database, self._store, stored.key)
        kind, artifact, whole_card = self._inspect(stored, card)
        wire_card = to_wire_card(whole_card).model_dump(mode="json")
        row = ModelRow(
            name=name,
            kind=kind,
            format=artifact.format,
            sha256=stored.sha256,
            size_bytes=stored.size_bytes,
            key=stored.key,
            card=wire_card,
            created_at=utc_now(),
        )
        for _ in range(_MOST_RIVALS):
            try:
                return self._insert(row, version)
            except IntegrityError:
                continue  # another version was published at the same moment: now the next number is another one
        return self._insert(row, version)

    def publish_file(
        self, name: str, path: Path, card: Card | None = None, version: int | None = None
    ) -> tuple[ModelVersion, bool]:
        """Store a local file and publish it; returns and raises as `publish`."""
        with path.open("rb") as source, self._store.writer(MODEL_PREFIX) as writer:
            while chunk := source.read(CHUNK_BYTES):
                writer.write(chunk)
            stored = writer.commit()
        return self.publish(name, stored, card, version)

    def resolve(self, reference: str) -> ModelVersion:
        """Return the version that `name@version`, `name` or an alias means now; raise ModelNotFoundError."""
        with self._database.read() as session:
            return _to_version(session, _resolve(session, reference))

    def get(self, name: str) -> Model:
        """Return a model with all its versions; raise ModelNotFoundError."""
        with self._database.read() as session:
            return _to_model(session, name)

    def artifact(self, name: str, version: int) -> Artifact:
        """Return where the bytes of a version lie; raise ModelNotFoundError."""
        with self._database.read() as session:
            row = _version_row(session, name, version)
            return Artifact(row.key, cast('Literal["safetensors", "onnx"]', row.format), row.sha256, row.size_bytes)

    def list_all(self) -> ModelList:
        """Return all models and aliases."""
        with self._database.read() as session:
            names = session.scalars(select(ModelRow.name).distinct().order_by(ModelRow.name)).all()
            aliases = session.scalars(select(AliasRow).order_by(AliasRow.alias))
            return ModelList(
                models=list(readable(names, lambda name: _to_model(session, name))),
                aliases=[_to_alias(row) for row in aliases],
            )

    def has_kind(self, kind: ModelKind) -> bool:
        """Return whether any model of that kind is registered."""
        with self._database.read() as session:
            return session.scalars(select(ModelRow.name).where(ModelRow.kind == kind).limit(1)).first() is not None

    def set_alias(self, alias: str, reference: str) -> Alias:
        """Point an alias to the version that the reference means now.

        Raises
        ------
        ModelNotFoundError
            If the reference means nothing.
        NameTakenError
            If a model has that name, or the name is reserved.
        ModelKindError
            If the alias means models of the other kind: specs that name it would break.
        """
        with self._database.write() as session:
            target = _resolve(session, reference)
            if alias in RESERVED_NAMES or session.scalars(select(ModelRow).where(ModelRow.name == alias)).first():
                raise NameTakenError(f"{alias!r} is the name of a model, or reserved")
            row = session.get(AliasRow, alias, with_for_update=True) or AliasRow(alias=alias)
            kind = _kind_of_alias(session, row)
            if kind not in (None, target.kind):
                raise ModelKindError(
                    f"{alias!r} means models of the kind {kind}; {reference} is of the kind {target.kind}"
                )
            row.name, row.version, row.updated_at = target.name, target.version, utc_now()
            session.add(row)
            return _to_alias(row)

    def _inspect(self, stored: StoredObject, card: Card | None) -> tuple[ModelKind, Artifact, Card]:
        with self._store.local_file(stored.key) as path:
            kind_of_file = artifact_format(path)
            artifact = Artifact(stored.key, kind_of_file, stored.sha256, stored.size_bytes)
            if kind_of_file == "onnx":
                check_network(path)
                return "autoencoder", artifact, card or read_network_card(path) or {}
            return "dictionary", artifact, read_dictionary_card(path)

    def _insert(self, row: ModelRow, version: int | None) -> tuple[ModelVersion, bool]:
        with self._database.write() as session:
            if row.name in RESERVED_NAMES or session.get(AliasRow, row.name) is not None:
                raise NameTakenError(f"{row.name!r} is an alias, or reserved")
            same = session.scalars(
                select(ModelRow).where(ModelRow.name == row.name, ModelRow.sha256 == row.sha256)
            ).one_or_none()
            if same is not None:
                return _to_version(session, same), False
            if version is None:
                latest = session.scalar(select(func.max(ModelRow.version)).where(ModelRow.name == row.name))
                version = (latest or 0) + 1
            elif session.get(ModelRow, (row.name, version)) is not None:
                raise NameTakenError(f"{row.name}@{version} is taken by other bytes; versions never change")
            fresh = ModelRow(**{c.key: getattr(row, c.key) for c in ModelRow.__table__.columns} | {"version": version})
            session.add(fresh)
            session.flush()
            return _to_version(session, fresh), True


def _kind_of_alias(session: Session, row: AliasRow) -> str | None:
    """Return the kind of model that an alias keeps to: that of its first target; None where it is free."""
    if row.name is None:
        return DEFAULT_KINDS.get(row.alias)
    return _version_row(session, row.name, row.version).kind


def _resolve(session: Session, reference: str) -> ModelRow:
    name, _, number = reference.partition("@")
    if number:
        return _version_row(session, name, int(number))
    alias = session.get(AliasRow, name)
    if alias is not None:
        return _version_row(session, alias.name, alias.version)
    query = select(ModelRow).where(ModelRow.name == name).order_by(ModelRow.version.desc()).limit(1)
    row = session.scalars(query).first()
    if row is None:
        raise ModelNotFoundError(f"there is no model and no alias {name!r}")
    return row


def _version_row(session: Session, name: str, version: int) -> ModelRow:
    row = session.get(ModelRow, (name, version))
    if row is None:
        raise ModelNotFoundError(f"there is no model {name}@{version}")
    return row


def _to_model(session: Session, name: str) -> Model:
    rows = session.scalars(select(ModelRow).where(ModelRow.name == name).order_by(ModelRow.version.desc())).all()
    if not rows:
        raise ModelNotFoundError(f"there is no model {name!r}")
    versions = list(readable(rows, lambda row: _to_version(session, row)))
    return Model(name=name, latest=rows[0].version, versions=versions)


def _to_version(session: Session, row: ModelRow) -> ModelVersion:
    path = f"/v1/models/{row.name}/versions/{row.version}"
    query = select(AliasRow.alias).where(AliasRow.name == row.name, AliasRow.version == row.version)
    aliases = session.scalars(query.order_by(AliasRow.alias)).all()
    values = {name: getattr(row, name) for name in ModelVersion.model_fields.keys() - {"aliases", "links"}}
    links = ModelLinks(self=path, artifact=f"{path}/artifact")
    return ModelVersion.model_validate({**values, "aliases": list(aliases), "links": links})


def _to_alias(row: AliasRow) -> Alias:
    return Alias(alias=row.alias, name=row.name, version=row.version, updated_at=row.updated_at)
