"""Clients that follow jobs by their event streams: one process, one connection for each client.

Run by `benchmarks.service` in a process of its own. The delay of an event is the time from the moment that it bears to
its arrival, both by the clock of this machine.

Tested in `tests/benchmarks/test_commands.py`.
"""

import argparse
import asyncio
import json
import sys
import time
from dataclasses import dataclass, field
from datetime import datetime

from benchmarks.polling import Plan


@dataclass
class Tally:
    """What came: delays in seconds of what happened meanwhile, and what went wrong."""

    delays: list[float] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)


async def follow_all(plan: Plan) -> Tally:
    """Follow one job with each client for the seconds of the plan."""
    tally = Tally()
    started = time.time()
    await asyncio.gather(*(_follow(plan, number, started, tally) for number in range(plan.n_clients)))
    return tally


async def _follow(plan: Plan, number: int, started: float, tally: Tally) -> None:
    reader, writer = await asyncio.open_connection(plan.host, plan.port)
    path = plan.paths[number % len(plan.paths)]
    head = f"GET {path}/events HTTP/1.1\r\nHost: {plan.host}:{plan.port}\r\nAccept: text/event-stream\r\n\r\n"
    writer.write(head.encode())
    last = 0
    try:
        async with asyncio.timeout(plan.seconds):
            status = (await reader.readline()).split()[1].decode()
            if status != "200":
                tally.errors.append(f"status {status}")
                return
            while line := await reader.readline():
                if line.startswith(b"data: "):
                    last = _note(json.loads(line[6:]), last, started, tally)
        tally.errors.append("the stream ended")
    except TimeoutError:
        pass  # the time is up
    except (OSError, ValueError) as error:
        tally.errors.append(repr(error))
    finally:
        writer.close()


def _note(event: dict[str, str], last: int, started: float, tally: Tally) -> int:
    sequence, at = int(event["sequence"]), datetime.fromisoformat(event["at"]).timestamp()
    if sequence != last + 1:
        tally.errors.append(f"event {sequence} after {last}")
    if at > started:
        tally.delays.append(time.time() - at)
    return sequence


def main() -> None:
    """Read the plan from stdin, follow, and write the tally to stdout; both are JSON."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    tally = asyncio.run(follow_all(Plan(**json.load(sys.stdin))))
    json.dump({"delays": tally.delays, "errors": tally.errors}, sys.stdout)


if __name__ == "__main__":
    main()
