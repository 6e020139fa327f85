"""What a training publishes besides its result: the model version, and the alias that is to point to it.

Both are written in the transaction that publishes the result, so that each training makes one version, however often
its attempts were lost.
"""

from sqlalchemy.orm import Session

from jobkit.database.session import Database
from jobkit.database.tables import ModelRow
from jobkit.database.tenancy import own_name, shown_name
from jobkit.errors import ConflictError, NameTakenError
from jobkit.models.aliases import point_alias
from jobkit.models.proofs import reference_of
from jobkit.models.publication import check_name, insert_version
from quadpatch_client.schema import JobResult, TrainingSpec


def check_names(database: Database, train: TrainingSpec) -> None:
    """Raise NameTakenError where a training can't name its model as asked, before it is accepted."""
    if train.model == train.alias and train.make_default != "never":
        raise NameTakenError(f"{train.model!r} can't name the model and the alias")
    with database.read() as session:
        check_name(session, own_name(database.tenant, train.model))


def register_learned(session: Session, result: JobResult, row: ModelRow, train: TrainingSpec) -> JobResult:
    """Write what was learned as a version of its model, and point the alias to it where that was asked for.

    Parameters
    ----------
    session : Session
        That publishes the result, of the tenant.
    result : JobResult
        With what was learned.
    row : ModelRow
        Not numbered yet.
    train : TrainingSpec

    Returns
    -------
    JobResult
        With the number of the version, and what became of the alias.

    Raises
    ------
    NameTakenError
        If the name of the model has been taken by another one meanwhile.
    """
    learned = result.training
    if learned is None:
        raise ValueError("the result of a training says what was learned")
    written, is_new = insert_version(session, row)
    alias, end = None, ""
    if train.make_default == "if_better":
        refusal = None if learned.is_better else ""
        if refusal is None:
            refusal = _refusal(session, train.alias, reference_of(shown_name(written.name), written.version))
        alias = train.alias if refusal is None else None
        end = f": made {train.alias}" if refusal is None else f": not made {train.alias}"
        end += f", since {refusal}" if refusal else ""
    values = {"version": written.version, "is_new": is_new, "alias": alias, "verdict": learned.verdict + end}
    return result.model_copy(update={"training": learned.model_copy(update=values)})


def _refusal(session: Session, alias: str, reference: str) -> str | None:
    """Point the alias; return why that can't be done, None where it is done."""
    try:
        point_alias(session, alias, reference)
    except ConflictError as error:
        return str(error)
    return None
