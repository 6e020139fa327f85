"""Mutated files through HTTP: what the service says of each, and what became of its processes."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import psutil

from tests.mutants.bases import drawn
from tests.mutants.mutations import HOSTILE_NAMES, MUTATIONS, mutated
from tests.waiting import GUARD_S, wait_until

# Errors without a code of their own: the engine met something that it was not made for.
UNCLEAR = ("engine_error", "engine_crashed", "internal_error", "")
_SPEC = {"method": {"method": "smooth"}, "output": {"preview": False}}
_KINDS = tuple(MUTATIONS)
# Of requests at the same time.
_N_CLIENTS = 4
_MB = 1 << 20


@dataclass(frozen=True)
class Mutant:
    """A file to send: its number, where it comes from, what was done to it, its name in the request."""

    number: int
    origin: str
    kind: str
    filename: str
    data: bytes


@dataclass(frozen=True)
class Outcome:
    """What the service said: `mesh`, or the code of an error; `fault` where that is no answer."""

    mutant: Mutant
    answer: str
    fault: str = ""


@dataclass
class Peaks:
    """The most memory that each process of the local stack has had, in MiB, by name of its program and process id."""

    mb: dict[tuple[str, int], float] = field(default_factory=dict)


def mutant(files: dict[str, bytes], seed: int, number: int) -> Mutant:
    """Draw the mutant of that number; the kinds of mutation take turns."""
    rng = np.random.default_rng([seed, number])
    origin, data = drawn(files, rng)
    kind = _KINDS[number % len(_KINDS)]
    suffix = Path(origin).suffix
    stem = HOSTILE_NAMES[int(rng.integers(len(HOSTILE_NAMES)))][:500].decode("utf-8", "replace")
    filename = (stem if kind == "names" else f"mutant {number}") + suffix
    return Mutant(number, origin, kind, filename, mutated(data, kind, rng))


def send_all(url: str, mutants: list[Mutant]) -> list[Outcome]:
    """Send all files, a few at a time, and repair what is taken."""
    with httpx.Client(base_url=url, timeout=GUARD_S) as client, ThreadPoolExecutor(_N_CLIENTS) as pool:
        return list(pool.map(lambda one: _outcome(client, one), mutants))


def _outcome(client: httpx.Client, one: Mutant) -> Outcome:
    try:
        return judged(one, _answer(client, one))
    except (httpx.HTTPError, KeyError, ValueError, AssertionError) as error:
        return Outcome(one, "", f"no answer: {error!r}")


def judged(one: Mutant, problem: tuple[str, str]) -> Outcome:
    answer, message = problem
    if answer in UNCLEAR:
        return Outcome(one, answer, f"an error without a code of its own: {message}")
    if not message.isprintable() or len(message) > 500:
        return Outcome(one, answer, f"a message that is no line of text: {message[:600]!r}")
    return Outcome(one, answer)


def _answer(client: httpx.Client, one: Mutant) -> tuple[str, str]:
    """Return `mesh` or the code of the error, and its message."""
    sent = client.post("/v1/meshes", params={"filename": one.filename}, content=one.data)
    if sent.is_client_error:
        return _problem(sent)
    mesh = sent.raise_for_status().json()
    started = client.post("/v1/jobs", json={"mesh_id": mesh["id"], **_SPEC})
    if started.is_client_error:
        return _problem(started)
    job = started.raise_for_status().json()
    path = f"/v1/jobs/{job['id']}"
    ended = wait_until(lambda: _ended(client.get(path, headers={"Prefer": "wait=20"}).raise_for_status().json()))
    if ended["state"] == "failed":
        return str(ended["error"]["code"]), str(ended["error"]["message"])
    return "mesh", _served(client, ended)


def _ended(job: dict[str, Any]) -> dict[str, Any] | None:
    return job if job["state"] not in ("queued", "running", "canceling") else None


def _served(client: httpx.Client, job: dict[str, Any]) -> str:
    """Fetch the mesh; what a job made has to be there."""
    client.get(job["links"]["result"]).raise_for_status()
    client.get(job["links"]["report"]).raise_for_status()
    return ""


def _problem(response: httpx.Response) -> tuple[str, str]:
    problem = response.json()
    return str(problem["code"]), str(problem["detail"])


def peaks(root: psutil.Process) -> Peaks:
    """Read the peaks of a process and all below it but engines, which come and go."""
    found = Peaks()
    for process in [root, *root.children(recursive=True)]:
        words = process.cmdline()
        if _is_lasting(process, words):
            name = words[words.index("-m") + 1] if "-m" in words else Path(words[0]).name
            found.mb[name, process.pid] = _peak_mb(process.pid)
    return found


def _is_lasting(process: psutil.Process, words: list[str]) -> bool:
    if not words:
        return False
    parent = process.parent()
    # An engine is a fork of its fork server, and so has its command line.
    return (
        parent is None
        or "worker.engine.fork_server" not in words
        or "worker.engine.fork_server" not in parent.cmdline()
    )


def _peak_mb(pid: int) -> float:
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return next(int(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM"))


def left_behind(data: Path) -> list[str]:
    """Return what lies in the folders of work and of incoming bytes."""
    places = [
        *(data / "work").glob("*/request-*"),
        *(data / "scratch").rglob("*"),
        *(data / "objects/incoming").glob("*"),
    ]
    return sorted(str(path.relative_to(data)) for path in places if path.is_file() or path.name.startswith("request-"))
