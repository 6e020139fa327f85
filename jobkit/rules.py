"""Rules by name. Versions never change; saving what differs from the latest makes the next one."""

import json

from sqlalchemy import func, select, update
from sqlalchemy.orm import Session

from jobkit.database.clock import utc_now
from jobkit.database.readable_rows import readable
from jobkit.database.rule_tables import RuleRow
from jobkit.database.session import Database
from jobkit.database.tenancy import own_name, shown_name
from jobkit.errors import RowConflictError, RuleNotFoundError
from quadpatch_client.schema import Rule, RuleContent, RuleLinks, RulePage

# Of one name, saved at the same moment.
_MOST_CONFLICTS = 20
_IS_THERE = RuleRow.deleted_at.is_(None)


class Rules:
    """All rules of a tenant.

    Parameters
    ----------
    database : Database
        As the tenant sees it.
    """

    def __init__(self, database: Database) -> None:
        self._database = database

    def save(self, name: str, content: RuleContent) -> tuple[Rule, bool]:
        """Save the next version; the same content as the latest is that version.

        Returns
        -------
        Rule, bool
            The version, and whether it is new.
        """
        for _ in range(_MOST_CONFLICTS):
            try:
                return self._save(name, content)
            except RowConflictError:
                continue  # another version was saved at the same moment: now the next number is another one
        return self._save(name, content)

    def get(self, name: str, version: int | None = None) -> Rule:
        """Return a version, None: the latest; raise RuleNotFoundError."""
        with self._database.read() as session:
            row = self._row(session, name, version)
            if row is None:
                reference = name if version is None else f"{name}@{version}"
                raise RuleNotFoundError(f"there is no rule {reference}")
            return _show(row)

    def resolve(self, reference: str) -> Rule:
        """Return what `name` or `name@version` means now; raise RuleNotFoundError."""
        name, _, number = reference.partition("@")
        return self.get(name, int(number) if number else None)

    def page(self, limit: int, cursor: str | None = None) -> RulePage:
        """Return rules by name, each in its latest version; `cursor` is the last name of the page before."""
        latest = select(RuleRow.name, func.max(RuleRow.version)).where(_IS_THERE).group_by(RuleRow.name)
        if cursor is not None:
            latest = latest.where(RuleRow.name > own_name(self._database.tenant, cursor))
        with self._database.read() as session:
            found = session.execute(latest.order_by(RuleRow.name).limit(limit + 1)).all()
            rows = [session.get_one(RuleRow, (name, version)) for name, version in found[:limit]]
            items = list(readable(rows, _show))
        next_cursor = shown_name(found[limit - 1].name) if len(found) > limit else None
        return RulePage(items=items, next_cursor=next_cursor)

    def versions(self, name: str, limit: int, below: int | None = None) -> RulePage:
        """Return the versions of a rule, of those below a number, the newest first; raise RuleNotFoundError."""
        query = select(RuleRow).where(RuleRow.name == own_name(self._database.tenant, name), _IS_THERE)
        if below is not None:
            query = query.where(RuleRow.version < below)
        self.get(name)
        with self._database.read() as session:
            rows = list(session.scalars(query.order_by(RuleRow.version.desc()).limit(limit + 1)))
            items = list(readable(rows[:limit], _show))
        return RulePage(items=items, next_cursor=str(rows[limit - 1].version) if len(rows) > limit else None)

    def delete(self, name: str) -> None:
        """Delete all versions of a rule; jobs keep what it said. Raise RuleNotFoundError."""
        self.get(name)
        is_it = (RuleRow.name == own_name(self._database.tenant, name)) & _IS_THERE
        with self._database.write() as session:
            session.execute(update(RuleRow).where(is_it).values(deleted_at=utc_now()))

    def _save(self, name: str, content: RuleContent) -> tuple[Rule, bool]:
        wire = content.model_dump(mode="json")
        with self._database.write() as session:
            latest = self._row(session, name)
            if latest is not None and latest.content == wire:
                return _show(latest), False
            own = own_name(self._database.tenant, name)
            number = session.scalar(select(func.max(RuleRow.version)).where(RuleRow.name == own)) or 0
            row = RuleRow(name=own, version=number + 1, content=wire, created_at=utc_now())
            session.add(row)
            session.flush()
            return _show(row), True

    def _row(self, session: Session, name: str, version: int | None = None) -> RuleRow | None:
        query = select(RuleRow).where(RuleRow.name == own_name(self._database.tenant, name), _IS_THERE)
        if version is not None:
            query = query.where(RuleRow.version == version)
        return session.scalars(query.order_by(RuleRow.version.desc()).limit(1)).first()


def _show(row: RuleRow) -> Rule:
    name = shown_name(row.name)
    path = f"/v1/rules/{name}"
    links = RuleLinks(self=f"{path}/versions/{row.version}", versions=f"{path}/versions", dry_run=f"{path}/dry-run")
    # As it was sent: JSON, in which a whole number may stand for another one.
    content = RuleContent.model_validate_json(json.dumps(row.content))
    return Rule(name=name, version=row.version, content=content, created_at=row.created_at, links=links)
