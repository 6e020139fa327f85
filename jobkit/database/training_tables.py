"""The meshes of trainings. A training is a job, see `jobkit.database.tables.JobRow`.

Tested in `tests/jobkit/jobs/test_trainings.py`.
"""

from sqlalchemy import ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from jobkit.database.table_base import Base


class TrainingMeshRow(Base):
    """A mesh that a training learns from or is judged on: it is kept as long as the job is."""

    __tablename__ = "training_meshes"
    job_id: Mapped[str] = mapped_column(String(40), ForeignKey("jobs.id"), primary_key=True)
    mesh_id: Mapped[str] = mapped_column(String(64), ForeignKey("meshes.id"), primary_key=True)
    __table_args__ = (Index(None, "mesh_id"),)
