"""One upload under accidents, and what must hold afterwards."""

import contextlib
import hashlib
import random
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import httpx

from jobkit.database.session import Database
from jobkit.storage.open import open_store
from jobkit.uploads.parts import named_parts
from tests.resumption.killable_service import KillableService
from tests.resumption.proxy import Proxy
from tests.waiting import GUARD_S, wait_until

MIB = 1 << 20


@dataclass(frozen=True)
class Trial:
    """An upload of `megabytes` MiB, with so many kills of the server and cuts of the connection on the way."""

    megabytes: int
    n_kills: int
    n_cuts: int
    seed: int


def write_file(path: Path, megabytes: int, seed: int) -> str:
    """Write random bytes, and a few more than whole MiB; return their sha256."""
    chance, digest = random.Random(seed), hashlib.sha256()
    with path.open("wb") as file:
        for n_bytes in [MIB] * megabytes + [12_345]:
            piece = chance.randbytes(n_bytes)
            digest.update(piece)
            file.write(piece)
    return digest.hexdigest()


@contextmanager
def running_service(folder: Path, variables: Mapping[str, str]) -> Iterator[KillableService]:
    """Run the service in a folder for the length of a `with` block."""
    (folder / "data").mkdir(parents=True, exist_ok=True)
    service = KillableService(folder, {"QUADPATCH_MODELS_DIR": str(folder / "models"), **variables})
    service.start()
    try:
        yield service
    finally:
        service.stop()


def run_trial(
    trial: Trial, folder: Path, variables: Mapping[str, str], send: Callable[[str, Path], str]
) -> dict[str, int]:
    """Send a file under accidents, and assert that the service has its bytes, once, and nothing else.

    Parameters
    ----------
    trial : Trial
    folder : Path
    variables : mapping
        Settings of the service.
    send : callable
        Sends a file to a URL; returns the id of its mesh.

    Returns
    -------
    dict of int
        Counts of what happened.
    """
    with running_service(folder, variables) as service:
        path = folder / "scan.ply"
        sha256 = write_file(path, trial.megabytes, trial.seed)
        accidents: list[Callable[[], None]] = [service.kill] * trial.n_kills + [lambda: None] * trial.n_cuts
        proxy = Proxy(service.port, path.stat().st_size, accidents, random.Random(trial.seed))
        with proxy.running():
            mesh_id = send(proxy.url, path)
        assert (mesh_id, proxy.n_due) == (sha256, 0)
        # Where several connections are open, one may wait for its accident while the others bring the rest.
        wait_until(lambda: service.n_kills == trial.n_kills)
        service.start()
        content = hashlib.sha256()
        with httpx.stream("GET", f"{service.url}/v1/meshes/{mesh_id}/content", timeout=GUARD_S) as answer:
            for chunk in answer.iter_raw():
                content.update(chunk)
        assert content.hexdigest() == sha256
        store = open_store(
            variables.get("QUADPATCH_OBJECT_STORE_URL") or f"file://{folder / 'data' / 'objects'}", folder / "scratch"
        )
        assert [listed.size_bytes for listed in store.keys("meshes")] == [path.stat().st_size]
        keys = {listed.key for listed in store.keys("uploads")}
        with contextlib.closing(Database(f"sqlite:///{folder / 'data' / 'quadpatch.db'}")) as database:
            orphans = len(keys - named_parts(database, keys))
        # A part is an orphan where its process was killed between its last byte and the row that names it.
        assert orphans <= trial.n_kills
        return {"kills": service.n_kills, "cuts": trial.n_cuts, "orphans": orphans}


def memory_growth(service: KillableService, n_mib: int) -> int:
    """Send an upload of random bytes in one request; return by how many bytes the service's memory grew."""
    url, chance = service.url, random.Random(n_mib)
    headers = {"Tus-Resumable": "1.0.0", "Content-Type": "application/offset+octet-stream"}
    with httpx.Client(base_url=url, headers=headers, timeout=GUARD_S) as client:
        small = client.post("/v1/uploads", headers={"Upload-Length": str(9 * MIB)}, content=chance.randbytes(9 * MIB))
        assert small.headers["quadpatch-mesh"]
        before = service.memory_bytes
        peaks = [before]
        made = client.post("/v1/uploads", headers={"Upload-Length": str(n_mib * MIB), "Content-Type": ""})

        def body() -> Iterator[bytes]:
            for _ in range(n_mib):
                yield chance.randbytes(MIB)
                peaks.append(service.memory_bytes)

        path = made.raise_for_status().headers["location"]
        with _watched(service, peaks):
            sent = client.patch(path, headers={"Upload-Offset": "0"}, content=body())
            assert sent.status_code == 204, sent.text
            wait_until(lambda: "quadpatch-mesh" in client.head(path).headers)
    return max(peaks) - before


@contextmanager
def _watched(service: KillableService, peaks: list[int]) -> Iterator[None]:
    """Look at the memory all the time, also while the parts are put together."""
    is_over = threading.Event()

    def look() -> None:
        while not is_over.wait(0.05):
            peaks.append(service.memory_bytes)

    thread = threading.Thread(target=look)
    thread.start()
    try:
        yield
    finally:
        is_over.set()
        thread.join()
