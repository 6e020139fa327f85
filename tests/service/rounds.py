"""Counting what goes on in one round of the event loop."""

import asyncio
from collections.abc import Awaitable, Callable


async def most_in_a_round(work: Callable[[], Awaitable[object]], n: int) -> int:
    """Start `n` at once; return how many at most came to their end in the same round."""
    n_ended, most = 0, 0

    async def do() -> None:
        nonlocal n_ended
        await work()
        n_ended += 1

    tasks = [asyncio.create_task(do()) for _ in range(n)]
    while n_ended < n:
        before = n_ended
        await asyncio.sleep(0)
        most = max(most, n_ended - before)
        assert not any(task.done() and task.exception() for task in tasks)
    await asyncio.gather(*tasks)
    return most
