"""Which jobs a list shows.

Tested in `tests/service/routes/test_finding.py`.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from sqlalchemy import ColumnElement

from jobkit.database.job_rows import names_mesh
from jobkit.database.searching import ALWAYS, Period, matches
from jobkit.database.tables import JobRow
from jobkit.database.tenancy import mesh_id_of
from quadpatch_client.schema import JobState, Task


@dataclass(frozen=True)
class JobSearch:
    """Which jobs are looked for; what is left out does not matter. `*` in a text stands for any characters.

    Attributes
    ----------
    states : collection of JobState
        Any of them.
    task : Task, optional
    mesh_id : str, optional
        That they work on, or learn from.
    batch_id : str, optional
        That they belong to.
    filename : str, optional
        Name of the mesh's file.
    label : str, optional
    metadata : mapping
        All of these facts, each exactly.
    created : Period
    finished : Period
    oldest_first : bool
    """

    states: Collection[JobState] = ()
    task: Task | None = None
    mesh_id: str | None = None
    batch_id: str | None = None
    filename: str | None = None
    label: str | None = None
    metadata: Mapping[str, str] = field(default_factory=dict)
    created: Period = ALWAYS
    finished: Period = ALWAYS
    oldest_first: bool = False

    def conditions(self, tenant: str | None) -> list[ColumnElement[bool]]:
        """Return the conditions on the rows of a tenant."""
        found = [
            JobRow.state.in_([state.value for state in self.states]) if self.states else None,
            None if self.task is None else JobRow.task == self.task,
            None if self.mesh_id is None else names_mesh(mesh_id_of(tenant, self.mesh_id)),
            None if self.batch_id is None else JobRow.batch_id == self.batch_id,
            None if self.filename is None else matches(JobRow.mesh_name, self.filename),
            None if self.label is None else matches(JobRow.spec["label"].as_string(), self.label),
            *(JobRow.spec["metadata"][name].as_string() == value for name, value in self.metadata.items()),
            self.created.condition(JobRow.created_at),
            self.finished.condition(JobRow.finished_at),
        ]
        return [condition for condition in found if condition is not None]
