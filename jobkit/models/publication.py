"""New versions of models, numbered in the transaction that writes them.

Tested in `tests/jobkit/jobs/test_trainings.py`.
"""

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from jobkit.database.tables import DeletedModelRow, ModelRow
from jobkit.database.tenancy import shown_name
from jobkit.errors import NameTakenError
from jobkit.models.aliases import RESERVED_NAMES
from jobkit.models.rows import alias_row
from quadpatch_client.schema import ModelState


def check_name(session: Session, own_name: str) -> None:
    """Raise NameTakenError where a model can't have a name, as it is among those of all tenants."""
    name = shown_name(own_name)
    if name in RESERVED_NAMES or alias_row(session, name) is not None:
        raise NameTakenError(f"{name!r} is an alias, or reserved")
    if own_name != name and session.scalars(select(ModelRow).where(ModelRow.name == name).limit(1)).first():
        raise NameTakenError(f"{name!r} is the name of a shared model; publish yours under another one")


def insert_version(session: Session, row: ModelRow, version: int | None = None) -> tuple[ModelRow, bool]:
    """Write a version under the next number, or the one asked for; the same bytes are the same version.

    Returns
    -------
    ModelRow, bool
        The row, and whether it is new.

    Raises
    ------
    NameTakenError
        If the name or the number is taken.
    RowConflictError
        From the end of the transaction, if another version was written at the same moment.
    """
    check_name(session, row.name)
    is_same = (ModelRow.name == row.name) & (ModelRow.sha256 == row.sha256)
    existing_row = session.scalars(select(ModelRow).where(is_same).with_for_update()).one_or_none()
    if existing_row is not None:
        _publish_again(existing_row, row)
        return existing_row, False
    new_version = _free_number(session, row.name, version)
    new_row = ModelRow(**{c.key: getattr(row, c.key) for c in ModelRow.__table__.columns} | {"version": new_version})
    session.add(new_row)
    session.flush()
    return new_row, True


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
