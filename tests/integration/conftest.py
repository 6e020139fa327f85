"""One real local stack for each test process, and meshes built in code."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import psutil
import pytest
from playwright.sync_api import Browser

from onebox.demo import running_stack
from quadpatch.types import Triangles, Vertices
from quadpatch_client.schema import Job, JobSpec
from quadpatch_client.sdk import Client
from tests.integration.browser import Service, Visit, running_chromium, visiting

# Short leases, so that the loss of a worker shows within seconds.
FAST = {
    "QUADPATCH_HEARTBEAT_S": "0.5",
    "QUADPATCH_LEASE_S": "8",
    "QUADPATCH_DISPATCH_S": "0.3",
    "QUADPATCH_LEADER_LEASE_S": "4",
}


@dataclass(frozen=True)
class RunningStack:
    """A local stack, its folder and its processes."""

    url: str
    data: Path

    def workers(self) -> list[psutil.Process]:
        """Living worker processes."""
        return self._processes("worker")

    def valkey(self) -> psutil.Process:
        """The server of the queue."""
        folder = str(self.data / "valkey")
        (server,) = [p for p in psutil.process_iter() if any(folder in word for word in _command(p))]
        return server

    def engines(self) -> list[psutil.Process]:
        """Living engine children of all workers."""
        fork_servers = [n for w in self.workers() for n in w.children() if "worker.engine.fork_server" in n.cmdline()]
        return [e for n in fork_servers for e in n.children() if e.status() != psutil.STATUS_ZOMBIE]

    def requests(self) -> list[Path]:
        """Folders of requests that lie on the disk."""
        return list((self.data / "work").glob("*/request-*"))

    def _processes(self, module: str) -> list[psutil.Process]:
        command = ["-m", module]
        log_owner = str(self.data)
        return [
            process
            for process in psutil.process_iter()
            if _command(process)[1:] == command and process.environ().get("QUADPATCH_DATA_DIR") == log_owner
        ]


@pytest.fixture(scope="session")
def run_stack(
    tmp_path_factory: pytest.TempPathFactory, new_places: Callable[[], AbstractContextManager[dict[str, str]]]
) -> Callable[..., AbstractContextManager[RunningStack]]:
    """Make a context manager that runs a local stack with some settings changed, by their variables."""

    @contextmanager
    def run(**changes: str) -> Iterator[RunningStack]:
        data = tmp_path_factory.mktemp("stack")
        with ExitStack() as exits:
            places = {f"QUADPATCH_{name.upper()}": url for name, url in exits.enter_context(new_places()).items()}
            # For the local stack alone: other tests of this process read the environment, too.
            with pytest.MonkeyPatch.context() as environment:
                for name, value in {**FAST, **places, **changes}.items():
                    environment.setenv(name, value)
                url = exits.enter_context(running_stack(data))
            yield RunningStack(url, data)

    return run


@pytest.fixture(scope="session")
def local_stack(run_stack: Callable[..., AbstractContextManager[RunningStack]]) -> Iterator[RunningStack]:
    with run_stack() as stack:
        yield stack


@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    with running_chromium() as browser:
        yield browser


@pytest.fixture
def visit(chromium: Browser, local_stack: RunningStack) -> Iterator[Visit]:
    """A window in a browser; in the end it has asked no other machine, and nothing has failed in it."""
    with visiting(chromium, local_stack.url) as visit:
        yield visit
        assert visit.hosts() <= {local_stack.url.removeprefix("http://")}
        assert visit.errors == []


@pytest.fixture
def api(local_stack: RunningStack) -> Iterator[Service]:
    service = Service(local_stack.url)
    with service.http:
        yield service


class FreshClient(Client):
    """A client whose jobs all run: many tests send the same mesh to one stack, and watch what is done with it."""

    def create_job(self, spec: JobSpec, idempotency_key: str | None = None, *, runs_anew: bool = True) -> Job:
        return super().create_job(spec, idempotency_key, runs_anew=runs_anew)


@pytest.fixture
def client(local_stack: RunningStack) -> Iterator[Client]:
    with FreshClient(local_stack.url) as client:
        yield client


def _command(process: psutil.Process) -> list[str]:
    try:
        return process.cmdline()
    except psutil.Error:
        return []


def punched_relief(n: int, n_holes: int = 4, radius: float = 0.06) -> tuple[Vertices, Triangles]:
    """A wavy square of side 1, n by n vertices, with a row of round holes."""
    axis = np.linspace(0.0, 1.0, n)
    x, y = np.meshgrid(axis, axis, indexing="xy")
    vertices = np.stack([x, y, 0.02 * np.sin(20.0 * x) * np.cos(15.0 * y)], axis=-1).reshape(-1, 3)
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    triangles = np.concatenate(
        [
            np.stack([corner, corner + 1, corner + n + 1], axis=1),
            np.stack([corner, corner + n + 1, corner + n], axis=1),
        ]
    )
    middles = vertices[triangles].mean(axis=1)[:, :2]
    centres = np.stack([(np.arange(n_holes) + 0.5) / n_holes, np.full(n_holes, 0.5)], axis=1)
    is_open = (np.linalg.norm(middles[:, None] - centres, axis=2) < radius).any(axis=1)
    kept = triangles[~is_open]
    used, renumbered = np.unique(kept, return_inverse=True)
    return vertices[used], renumbered.reshape(-1, 3).astype(np.int64)


def ply_bytes(vertices: Vertices, triangles: Triangles, kind: str = "float") -> bytes:
    """Binary PLY with `float` or `double` coordinates."""
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
        + "".join(f"property {kind} {axis}\n" for axis in "xyz")
        + f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.zeros(len(triangles), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, triangles
    return header.encode() + vertices.astype("<f4" if kind == "float" else "<f8").tobytes() + faces.tobytes()


def stl_bytes(vertices: Vertices, triangles: Triangles) -> bytes:
    """Binary STL with zero normals."""
    facets = np.zeros(len(triangles), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    facets["corners"] = vertices[triangles]
    return b"\0" * 80 + np.uint32(len(triangles)).tobytes() + facets.tobytes()


@pytest.fixture
def relief_file(tmp_path: Path) -> Callable[[str], Path]:
    """Writes a punched relief as `float.ply`, `double.ply` or `binary.stl`."""

    def write(name: str) -> Path:
        vertices, triangles = punched_relief(40)
        path = tmp_path / name
        if name.endswith(".stl"):
            path.write_bytes(stl_bytes(vertices, triangles))
        else:
            path.write_bytes(ply_bytes(vertices, triangles, path.stem))
        return path

    return write


@pytest.fixture(scope="session")
def large_relief(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A relief of 25,600 vertices with four holes."""
    path = tmp_path_factory.mktemp("meshes") / "large.ply"
    path.write_bytes(ply_bytes(*punched_relief(160)))
    return path


@pytest.fixture(scope="session")
def fine_relief(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A relief with small holes, 62,500 vertices."""
    path = tmp_path_factory.mktemp("fine") / "fine.ply"
    path.write_bytes(ply_bytes(*punched_relief(250, radius=0.02)))
    return path
