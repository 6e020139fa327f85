"""What tests of several parts share: a fresh database and store, and one real Valkey per test process.

TEST_BACKEND=postgres-s3 puts a real PostgreSQL and an S3 server under all of them, in place of SQLite and local files.
"""

import functools
import os
import shutil
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import hypothesis
import numpy as np
import pytest
from pydantic import SecretStr

from jobkit.database.session import Database
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from jobkit.storage.open import open_store
from onebox.valkey import running_valkey
from quadpatch.inpainters.model_file import save_dictionary
from quadpatch.patches.normalisation import HEIGHTS, NORMALISATION
from quadpatch.sparse.dictionary import Dictionary
from tests.distribution import SharingScheduling
from tests.servers import PostgresServer, S3Server, fresh_bucket, fresh_database, running_postgres, running_s3
from tests.waiting import end, wait_until_answered

# How long an example takes says more about the machine than about the code. The examples are the same in every run:
# what fails for one newcomer fails for all. `make explore` looks for others.
hypothesis.settings.register_profile(
    "tests", deadline=None, suppress_health_check=[hypothesis.HealthCheck.too_slow], derandomize=True, max_examples=30
)
hypothesis.settings.register_profile(
    "explore", hypothesis.settings.get_profile("tests"), derandomize=False, max_examples=300, print_blob=True
)
hypothesis.settings.load_profile(os.environ.get("TEST_EXAMPLES", "tests"))

BACKENDS = ("sqlite-local", "postgres-s3")


def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> SharingScheduling | None:
    """Let `--dist loadfile` keep together what shares the local stack."""
    return SharingScheduling(config, log) if config.getvalue("dist") == "loadfile" else None


@pytest.fixture(scope="session")
def backend() -> str:
    """What this run of the tests stands on; one of `BACKENDS`."""
    named = os.environ.get("TEST_BACKEND") or BACKENDS[0]
    assert named in BACKENDS, f"TEST_BACKEND={named} is none of {BACKENDS}"
    return named


@pytest.fixture
def local_backend(backend: str) -> None:
    """Leave the test out where the service does not stand on local files."""
    if backend != "sqlite-local":
        pytest.skip("it is about the files of SQLite and of the local store")


@pytest.fixture(scope="session")
def postgres() -> Iterator[PostgresServer]:
    """A real PostgreSQL; tests take databases of their own."""
    with running_postgres() as server:
        yield server


@pytest.fixture(scope="session")
def s3() -> Iterator[S3Server]:
    """A real S3 server, and the AWS_ variables that lead to it; tests take buckets of their own."""
    with pytest.MonkeyPatch.context() as environment, running_s3() as server:
        for name, value in server.variables.items():
            environment.setenv(name, value)
        yield server


@pytest.fixture(scope="session")
def new_places(backend: str, request: pytest.FixtureRequest) -> Callable[[], AbstractContextManager[dict[str, str]]]:
    """Make a context manager that gives `database_url` and `object_store_url`, both empty for the defaults."""

    @contextmanager
    def places() -> Iterator[dict[str, str]]:
        if backend == "sqlite-local":
            yield {"database_url": "", "object_store_url": ""}
            return
        server, postgres = request.getfixturevalue("s3"), request.getfixturevalue("postgres")
        with fresh_bucket(server) as bucket, fresh_database(postgres) as url:
            yield {"database_url": url, "object_store_url": f"s3://{bucket}/a/prefix"}

    return places


@pytest.fixture(scope="session")
def valkey_url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Address of a real Valkey; tests that need an empty queue take a queue name of their own."""
    with running_valkey(tmp_path_factory.mktemp("valkey")) as url:
        yield url


@pytest.fixture(scope="session")
def migrated_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A migrated, empty SQLite database to copy: a tenth of a second saved in every test."""
    path = tmp_path_factory.mktemp("database") / "quadpatch.db"
    database = Database(f"sqlite:///{path}")
    database.migrate()
    database.close()
    return path


@pytest.fixture
def data_dir(tmp_path: Path, migrated_file: Path) -> Path:
    """A fresh data folder with an empty database."""
    folder = tmp_path / "data"
    folder.mkdir()
    shutil.copy(migrated_file, folder / "quadpatch.db")
    return folder


@pytest.fixture
def places(new_places: Callable[[], AbstractContextManager[dict[str, str]]]) -> Iterator[dict[str, str]]:
    """The URLs of a migrated, empty database and of an empty store; empty where they lie in `data_dir`."""
    with new_places() as fresh:
        yield fresh


@pytest.fixture
def settings(tmp_path: Path, data_dir: Path, valkey_url: str, places: dict[str, str]) -> Settings:
    """Settings of a local stack in a fresh folder with a queue of its own."""
    return Settings(
        data_dir=data_dir,
        database_url=SecretStr(places["database_url"]),
        object_store_url=places["object_store_url"],
        redis_url=SecretStr(valkey_url),
        queue_name=f"test-{tmp_path.name.replace('_', '-').lower()}",
        models_dir=tmp_path / "models",
    )


@pytest.fixture
def database(data_dir: Path, places: dict[str, str]) -> Iterator[Database]:
    """The database that `settings` names."""
    fresh = Database(places["database_url"] or f"sqlite:///{data_dir / 'quadpatch.db'}")
    yield fresh
    fresh.close()


@pytest.fixture
def store(data_dir: Path, places: dict[str, str]) -> ObjectStore:
    """The empty store that `settings` names."""
    return open_store(places["object_store_url"] or f"file://{data_dir / 'objects'}", data_dir / "scratch")


@pytest.fixture
def break_store(request: pytest.FixtureRequest, data_dir: Path, places: dict[str, str]) -> Callable[[], None]:
    """Take the store away, as a disk that is unmounted or a bucket that is removed."""

    def act() -> None:
        if not places["object_store_url"]:
            shutil.rmtree(data_dir / "objects")
        else:
            request.getfixturevalue("s3").drop(urlsplit(places["object_store_url"]).netloc)

    return act


@pytest.fixture
def break_database(request: pytest.FixtureRequest, data_dir: Path, places: dict[str, str]) -> Callable[[], None]:
    """Take the database away; on SQLite, close what is open before."""

    def act() -> None:
        if not places["database_url"]:
            for path in data_dir.glob("quadpatch.db*"):
                path.unlink()
            (data_dir / "quadpatch.db").mkdir()
        else:
            request.getfixturevalue("postgres").drop(places["database_url"].rpartition("/")[2])

    return act


@pytest.fixture(scope="session")
def dictionary_bytes(tmp_path_factory: pytest.TempPathFactory) -> Callable[[int], bytes]:
    """Make small dictionary files as training writes them, another one for every seed; below 0: for recipe paper."""
    folder = tmp_path_factory.mktemp("dictionaries")

    def make(seed: int) -> bytes:
        atoms = np.random.default_rng(abs(seed)).normal(size=(64, 5))
        dictionary = Dictionary(atoms / np.linalg.norm(atoms, axis=0), 8, 3)
        path = folder / f"{seed}.safetensors"
        card = {"description": f"seed {seed}", "licence": "GPL-3.0-or-later", "seed": seed}
        save_dictionary(path, dictionary, card, NORMALISATION if seed >= 0 else HEIGHTS)
        return path.read_bytes()

    return make


@pytest.fixture(scope="session")
def unlearned_models(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of models whose `general-residual@1` has learned nothing yet: all that it may know is of the mesh."""
    import torch  # noqa: PLC0415 - torch takes seconds to load, and few tests need it

    from quadpatch.networks.residual import Residual  # noqa: PLC0415
    from tests.quadpatch.networks.made import stirred, write_residual  # noqa: PLC0415

    folder = tmp_path_factory.mktemp("unlearned")
    torch.manual_seed(0)
    write_residual(folder / "general-residual@1.onnx", stirred(Residual(), by=1e-5))
    return folder


@dataclass(frozen=True)
class RunningService:
    """`python -m service` in a process of its own."""

    url: str
    process: subprocess.Popen[bytes]


@pytest.fixture(scope="session")
def run_service(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., AbstractContextManager[RunningService]]:
    """Make a context manager that runs the service with given settings, some of them changed by keyword."""

    @contextmanager
    def run(settings: Settings, **changes: object) -> Iterator[RunningService]:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        values = {
            "data_dir": settings.data_dir,
            "database_url": settings.database_url.get_secret_value(),
            "object_store_url": settings.object_store_url,
            "redis_url": settings.redis_url.get_secret_value(),
            "queue_name": settings.queue_name,
            "models_dir": settings.models_dir,
            "port": port,
            "log_level": "warning",
        } | changes
        named = {f"QUADPATCH_{name.upper()}": str(value) for name, value in values.items()}
        environment = {name: value for name, value in os.environ.items() if not name.startswith("QUADPATCH_")}
        with (tmp_path_factory.mktemp("service") / "log").open("wb") as log:
            process = subprocess.Popen(
                [sys.executable, "-m", "service"], env=environment | named, stdout=log, stderr=subprocess.STDOUT
            )
        try:
            wait_until_answered(f"http://127.0.0.1:{port}/healthz", process, Path(log.name))
            yield RunningService(f"http://127.0.0.1:{port}", process)
        finally:
            end(process)

    return run


@pytest.fixture
def serve(
    settings: Settings, run_service: Callable[..., AbstractContextManager[RunningService]]
) -> Callable[..., AbstractContextManager[RunningService]]:
    """Run the service with the settings of this test."""
    return functools.partial(run_service, settings)
