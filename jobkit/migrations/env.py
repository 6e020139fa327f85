"""Runs migrations on the connection that jobkit.database.session hands over."""

from alembic import context

from jobkit.database import access_tables, rule_tables, shadow_tables, training_tables, upload_tables, view_tables  # noqa: F401 - their tables join the metadata
from jobkit.database.tables import MeshRow

connection = context.config.attributes["connection"]
context.configure(connection=connection, target_metadata=MeshRow.metadata, render_as_batch=True)
with context.begin_transaction():
    context.run_migrations()
