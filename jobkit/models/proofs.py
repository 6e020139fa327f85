"""Proofs of published models: a worker opens each version once, in an engine, before it may be used.

A proof is fenced like a job: starting it raises `attempt`, and only the latest attempt may write.

Tested in `tests/worker/test_proofs.py`.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import select, update
from sqlalchemy.orm import Session

from jobkit.database.clock import shared_now
from jobkit.database.session import Database
from jobkit.database.tables import ModelRow
from jobkit.errors import StaleAttemptError
from jobkit.models.rows import to_version, version_row
from quadpatch_client.schema import ModelProblem, ModelState, ModelVersion

# Proofs before a version is refused.
MAX_PROOFS = 3


@dataclass(frozen=True)
class Proof:
    """One try at proving a version; `is_last` where a failure of it refuses the version.

    `name` is that of the model among those of all tenants.
    """

    model: ModelVersion
    name: str
    attempt: int
    is_last: bool = False

    @property
    def reference(self) -> str:
        """The version as specs name it."""
        return reference_of(self.model.name, self.model.version)


class Proofs:
    """The proofs of all models of a database."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def start(self, reference: str, worker: str, lease_s: float) -> Proof:
        """Take a version for proof.

        Raises
        ------
        ModelNotFoundError
            If there is no such version.
        StaleAttemptError
            If another worker has it, or nothing is to be done.
        """
        name, version = parts_of(reference)
        with self._database.write() as session:
            now = shared_now(session)
            row = version_row(session, name, version, lock=True)
            is_leased = row.lease_until is not None and row.lease_until > now
            if row.state != ModelState.PROVING or is_leased:
                raise StaleAttemptError(f"model {reference} is {row.state} and not to be proven now")
            row.attempt += 1
            row.worker, row.lease_until = worker, now + timedelta(seconds=lease_s)
            session.flush()
            return Proof(to_version(session, row), row.name, row.attempt, row.attempt - row.forgiven >= MAX_PROOFS)

    def unfinished(self, references: Collection[str]) -> set[str]:
        """Return those of the versions whose proof is still to come."""
        names = {parts_of(reference)[0] for reference in references}
        query = select(ModelRow.name, ModelRow.version)
        is_wanted = (ModelRow.name.in_(names)) & (ModelRow.state == ModelState.PROVING.value)
        with self._database.read() as session:
            proving = {reference_of(name, version) for name, version in session.execute(query.where(is_wanted))}
        return proving & set(references)

    def renew(self, proof: Proof, lease_s: float) -> None:
        """Prolong the lease; raise StaleAttemptError where the proof was taken away."""
        self._write(proof, {}, lease_s)

    def accept(self, proof: Proof) -> None:
        """Let the version be used; raise StaleAttemptError."""
        self._write(proof, {"state": ModelState.READY.value, "problem": None, "lease_until": None})

    def refuse(self, proof: Proof, problem: ModelProblem) -> None:
        """Write why the version can't be used; raise StaleAttemptError."""
        wire = problem.model_dump(mode="json")
        self._write(proof, {"state": ModelState.REFUSED.value, "problem": wire, "lease_until": None})

    def release(self, proof: Proof) -> None:
        """Hand a proof back undone; raise StaleAttemptError."""
        self._write(proof, {"lease_until": None, "enqueued_at": None})

    def forgive(self, proof: Proof, delay_s: float = 0.0) -> None:
        """Hand a proof back, and don't count it: what ended it lies outside of the model.

        No worker takes the version for `delay_s` seconds. Raises StaleAttemptError.
        """
        self._write(proof, {"lease_until": None, "enqueued_at": None, "forgiven": ModelRow.forgiven + 1}, delay_s)

    def _write(self, proof: Proof, values: Mapping[str, object], lease_s: float = 0.0) -> None:
        with self._database.write() as session:
            if lease_s:
                values = {**values, "lease_until": shared_now(session) + timedelta(seconds=lease_s)}
            result = session.execute(
                update(ModelRow)
                .where(
                    ModelRow.name == proof.name,
                    ModelRow.version == proof.model.version,
                    ModelRow.attempt == proof.attempt,
                    ModelRow.state == ModelState.PROVING.value,
                )
                .values(**values)
            )
            if result.rowcount != 1:  # type: ignore[attr-defined]
                raise StaleAttemptError(f"proof {proof.attempt} of model {proof.reference} is no longer the latest")


def give_up_proofs(session: Session, now: datetime) -> None:
    """Refuse versions whose proof was lost as often as it may be."""
    problem = ModelProblem(code="proof_failed", message=f"the proof was lost {MAX_PROOFS} times")
    is_lost = (ModelRow.attempt - ModelRow.forgiven >= MAX_PROOFS) & (ModelRow.lease_until < now)
    session.execute(
        update(ModelRow)
        .where(ModelRow.state == ModelState.PROVING.value, is_lost)
        .values(state=ModelState.REFUSED.value, problem=problem.model_dump(mode="json"))
    )


def reference_of(name: str, version: int) -> str:
    """Return a version as specs name it."""
    return f"{name}@{version}"


def parts_of(reference: str) -> tuple[str, int]:
    """Return name and number of `name@version`."""
    name, _, number = reference.partition("@")
    return name, int(number)
