"""Clients that take places and give nothing: one process, one connection for each client.

Run by `benchmarks.flood` in a process of its own. Some wait for a job that does not end, some begin a body and never
send it, some send a head without an end. A client whose connection ends comes again a few seconds later.

Tested in `tests/benchmarks/test_commands.py`.
"""

import argparse
import asyncio
import json
import resource
import sys
from dataclasses import asdict, dataclass, field, replace
from random import Random

from jobkit.settings import Settings

# Seconds until a client comes again; `Retry-After` of a refusal says two.
_AGAIN_S = 2.0, 4.0
_HEADER_S = 0.1
_SPARE_DESCRIPTORS = 64


@dataclass(frozen=True)
class Flood:
    """How many of each kind, and where.

    Attributes
    ----------
    host : str
    port : int
    job_path : str
        Of a job that does not end.
    n_waiters, n_half_open, n_endless : int
    """

    host: str
    port: int
    job_path: str
    n_waiters: int = 1000
    n_half_open: int = 1100
    n_endless: int = 40


@dataclass
class Tally:
    """How often which kind of client got which status, how many are open now, and how many ever were."""

    answers: dict[str, int] = field(default_factory=dict)
    n_open: int = 0
    n_opened: int = 0

    def note(self, name: str, answer: str) -> None:
        """Count an answer to a kind of client."""
        self.answers[f"{name} {answer}"] = self.answers.get(f"{name} {answer}", 0) + 1


async def flood(plan: Flood, tally: Tally) -> None:
    """Keep all connections of the plan open until cancelled."""
    host = f"Host: {plan.host}:{plan.port}\r\n"
    wait = f"GET {plan.job_path} HTTP/1.1\r\n{host}Prefer: wait={Settings.model_fields['max_wait_s'].default:g}\r\n\r\n"
    half = f"POST /v1/meshes HTTP/1.1\r\n{host}Content-Length: 9\r\n\r\n"
    endless = f"GET / HTTP/1.1\r\n{host}"
    sent = [(name, text.encode()) for name, text in (("waiter", wait), ("half-open", half), ("endless", endless))]
    counts = plan.n_waiters, plan.n_half_open, plan.n_endless
    clients = [client for client, n in zip(sent, counts, strict=True) for _ in range(n)]
    rng = Random(1)
    await asyncio.gather(*(_keep_open(plan, name, data, tally, rng) for name, data in clients))


async def _keep_open(plan: Flood, name: str, data: bytes, tally: Tally, rng: Random) -> None:
    is_first = True
    while True:
        try:
            reader, writer = await asyncio.open_connection(plan.host, plan.port)
        except OSError:
            tally.note(name, "not connected")
        else:
            tally.n_opened += is_first
            is_first = False
            tally.note(name, await _hold(reader, writer, data, is_endless=name == "endless", tally=tally))
        await asyncio.sleep(rng.uniform(*_AGAIN_S))


async def _hold(
    reader: asyncio.StreamReader, writer: asyncio.StreamWriter, data: bytes, *, is_endless: bool, tally: Tally
) -> str:
    """Send the data and wait; return the status of the answer, or `closed`."""
    tally.n_open += 1
    first = asyncio.create_task(reader.readline())
    try:
        writer.write(data)
        while is_endless and not first.done():
            writer.write(b"X: y\r\n")
            await asyncio.wait([first], timeout=_HEADER_S)
        line = await first
        return line.split()[1].decode() if line else "closed"
    except OSError:
        return "closed"
    finally:
        first.cancel()
        tally.n_open -= 1
        writer.close()


async def run(plan: Flood) -> Tally:
    """Flood until stdin ends; print a line when each client has had its first connection."""
    tally = Tally()
    clients = asyncio.create_task(flood(plan, tally))
    while tally.n_opened < plan.n_waiters + plan.n_half_open + plan.n_endless:
        await asyncio.sleep(0.05)
    sys.stdout.write("open\n")
    sys.stdout.flush()
    await asyncio.to_thread(sys.stdin.read)
    now = replace(tally, answers=dict(tally.answers))
    clients.cancel()
    await asyncio.gather(clients, return_exceptions=True)
    return now


def main() -> None:
    """Read the plan from a line of stdin, flood, and write the tally to stdout; both are JSON."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    plan = Flood(**json.loads(sys.stdin.readline()))
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    needed = plan.n_waiters + plan.n_half_open + plan.n_endless + _SPARE_DESCRIPTORS
    resource.setrlimit(resource.RLIMIT_NOFILE, (needed if hard == resource.RLIM_INFINITY else min(needed, hard), hard))
    json.dump(asdict(asyncio.run(run(plan))), sys.stdout)


if __name__ == "__main__":
    main()
