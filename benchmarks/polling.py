"""Clients that poll jobs: one process, one connection for each client, and the time of every answer.

Run by `benchmarks.service` in a process of its own, so that the service shares no interpreter with its load. A client
polls at fixed moments, whatever the answers take, and an answer's time counts from the moment at which it was due: a
service that falls behind can't hide it by slowing its clients down.

Tested in `tests/benchmarks/test_commands.py`.
"""

import argparse
import asyncio
import contextlib
import json
import sys
import time
from dataclasses import dataclass, field
from http import HTTPStatus


@dataclass(frozen=True)
class Plan:
    """What the clients do.

    Attributes
    ----------
    host, port : str, int
    paths : list of str
        One for each client, again from the first where there are more clients.
    n_clients : int
    seconds : float
        For how long they poll.
    interval_s : float
        Between two polls of a client; 0: the next one follows as soon as the last is answered.
    is_conditional : bool
        Whether a client sends the entity tag that it knows.
    """

    host: str
    port: int
    paths: list[str]
    n_clients: int
    seconds: float
    interval_s: float
    is_conditional: bool


@dataclass
class Tally:
    """What came of it; times in seconds."""

    times: list[float] = field(default_factory=list)
    unchanged: int = 0
    errors: list[str] = field(default_factory=list)


async def poll_all(plan: Plan) -> Tally:
    """Let all clients poll at once, their moments spread evenly over the interval."""
    tally = Tally()
    loop = asyncio.get_running_loop()
    start = loop.time() + 0.5
    await asyncio.gather(*(_poll(plan, number, start, tally) for number in range(plan.n_clients)))
    return tally


async def _poll(plan: Plan, number: int, start: float, tally: Tally) -> None:
    loop = asyncio.get_running_loop()
    reader, writer = await asyncio.open_connection(plan.host, plan.port)
    path = plan.paths[number % len(plan.paths)]
    request = f"GET {path} HTTP/1.1\r\nHost: {plan.host}:{plan.port}\r\nAccept: application/json\r\n"
    send_at, tag = start + plan.interval_s * number / plan.n_clients, ""
    try:
        while send_at < start + plan.seconds:
            await asyncio.sleep(max(send_at - loop.time(), 0))
            condition = f"If-None-Match: {tag}\r\n" if tag and plan.is_conditional else ""
            writer.write(f"{request}{condition}\r\n".encode())
            status, tag = await _answer(reader, tag)
            tally.times.append(loop.time() - send_at)
            tally.unchanged += status == HTTPStatus.NOT_MODIFIED
            if status not in (HTTPStatus.OK, HTTPStatus.NOT_MODIFIED):
                tally.errors.append(f"status {status}")
            send_at = send_at + plan.interval_s if plan.interval_s else loop.time()
    except (OSError, EOFError, ValueError) as error:
        tally.errors.append(repr(error))
    finally:
        writer.close()
        with contextlib.suppress(OSError):
            await writer.wait_closed()


async def _answer(reader: asyncio.StreamReader, tag: str) -> tuple[int, str]:
    """Read one whole answer; return its status and entity tag."""
    head = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1").split("\r\n")
    headers = {name.lower(): value.strip() for name, _, value in (line.partition(":") for line in head[1:] if line)}
    await reader.readexactly(int(headers.get("content-length", "0")))
    return int(head[0].split(" ")[1]), headers.get("etag", tag)


def main() -> None:
    """Read the plan from stdin, poll, and write the tally to stdout; both are JSON."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    plan = Plan(**json.load(sys.stdin))
    started, cpu_s = time.monotonic(), time.process_time()
    tally = asyncio.run(poll_all(plan))
    used = {"wall_s": time.monotonic() - started, "cpu_s": time.process_time() - cpu_s}
    json.dump({"times": tally.times, "unchanged": tally.unchanged, "errors": tally.errors, **used}, sys.stdout)


if __name__ == "__main__":
    main()
