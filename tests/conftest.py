"""What tests of several parts share: a fresh database and store, and one real Valkey per test process."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from pydantic import SecretStr

from jobkit.database import Database
from jobkit.settings import Settings
from jobkit.store import ObjectStore, open_store
from onebox.valkey import running_valkey


@pytest.fixture(scope="session")
def valkey_url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Address of a real Valkey; tests that need an empty queue take a queue name of their own."""
    with running_valkey(tmp_path_factory.mktemp("valkey")) as url:
        yield url


@pytest.fixture
def settings(tmp_path: Path, valkey_url: str) -> Settings:
    """Settings of one box in a fresh folder with a queue of its own."""
    return Settings(
        data_dir=tmp_path / "data",
        redis_url=SecretStr(valkey_url),
        queue_name=f"test-{tmp_path.name.replace('_', '-').lower()}",
        models_dir=tmp_path / "models",
    )


@pytest.fixture
def database(tmp_path: Path) -> Iterator[Database]:
    """A migrated SQLite database."""
    fresh = Database(f"sqlite:///{tmp_path / 'data' / 'quadpatch.db'}")
    fresh.migrate()
    yield fresh
    fresh.close()


@pytest.fixture
def store(tmp_path: Path) -> ObjectStore:
    """An empty store in the folder that `settings` names."""
    return open_store(f"file://{tmp_path / 'data' / 'objects'}")
