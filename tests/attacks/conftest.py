"""The app in this process, as the tests of the service have it."""

from tests.service.conftest import client, finish, job_id, mesh_id, publish, services

__all__ = ["client", "finish", "job_id", "mesh_id", "publish", "services"]
