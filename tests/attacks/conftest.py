"""The app in this process, as the tests of the service have it, and a service in a process of its own."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager

import pytest
from pydantic import SecretStr

from jobkit.settings import Settings
from tests.conftest import RunningService
from tests.service.conftest import client, finish, job_id, mesh_id, publish, services

__all__ = ["client", "finish", "job_id", "mesh_id", "publish", "services", "shared_service"]


@pytest.fixture(scope="session")
def shared_service(
    run_service: Callable[..., AbstractContextManager[RunningService]],
    new_places: Callable[[], AbstractContextManager[dict[str, str]]],
    tmp_path_factory: pytest.TempPathFactory,
    valkey_url: str,
) -> Iterator[RunningService]:
    """A service without keys, started once, for tests that need none of its data and leave it running."""
    folder = tmp_path_factory.mktemp("shared-service")
    with new_places() as places:
        settings = Settings(
            data_dir=folder,
            database_url=SecretStr(places["database_url"]),
            object_store_url=places["object_store_url"],
            redis_url=SecretStr(valkey_url),
            queue_name="attacks",
            models_dir=folder / "models",
        )
        with run_service(settings) as running:
            yield running
