"""The periodic task that delivers messages to subscribers: many at a time, a few to each, none waiting for another.

A round lasts as long as there is anything to send. Deliveries are at least once: a message whose answer could not be
recorded is sent again, under the same id.
"""

import asyncio
import logging
import random
import time
from collections import Counter
from collections.abc import Callable
from contextlib import closing
from datetime import timedelta

from standardwebhooks.webhooks import EmptyWebhookSecretError

from dispatcher.outbox import Claim, claim_due, is_anything_due, note_answer
from dispatcher.sending import Answer, Sender
from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.settings import Settings
from jobkit.webhooks.deliveries import Deliveries

MAX_PARALLEL = 64
# Between two queries for due deliveries while others are being sent.
_LOOK_S = 0.5
# A request that is being sent at the end gets this long; if it is broken off, it is sent again later.
_GRACE_S = 2.0
# Beyond the longest request, for the look-up before it and the record after it.
_CLAIM_MARGIN_S = 30.0
_BATCH = 1000
# What a stored URL, secret or payload that no request can be made of raises; `Sender.send` answers all else itself.
_UNSENDABLE = (ValueError, LookupError, RuntimeError, EmptyWebhookSecretError)

_log = logging.getLogger("quadpatch.dispatcher.webhooks")
IsOver = Callable[[], bool]


def deliver_webhooks(database: Database, settings: Settings, is_over: IsOver) -> str:
    """Send what is due, until nothing is; return words about it for the log."""
    if is_over() or not is_anything_due(database):
        return ""
    with closing(Sender(settings.webhook_networks, settings.webhook_timeout_s)) as sender:
        sending = _Round(database, sender, settings.webhook_timeout_s + _CLAIM_MARGIN_S, is_over)
        asyncio.run(sending.run())
    return str(dict(sending.outcomes))


def forget_old_deliveries(database: Database, days: float, is_over: IsOver) -> str:
    """Remove deliveries that ended more than some days ago; return words about it for the log."""
    deliveries, moment, removed = Deliveries(database), utc_now() - timedelta(days=days), 0
    while not is_over():
        batch = deliveries.forget_before(moment, _BATCH)
        removed += batch
        if batch < _BATCH:
            break
    return f"{removed} old deliveries removed" if removed else ""


class _Round:
    """One run of the periodic task."""

    def __init__(self, database: Database, sender: Sender, claim_s: float, is_over: IsOver) -> None:
        self._database = database
        self._sender = sender
        self._claim_s = claim_s
        self._is_over = is_over
        self._at_work: dict[asyncio.Task[None], Claim] = {}
        self.outcomes: Counter[str] = Counter()

    async def run(self) -> None:
        try:
            while not self._is_over() and await self._start_due_deliveries():
                await self._wait_for_one(_LOOK_S)
            deadline = time.monotonic() + _GRACE_S
            while self._at_work and time.monotonic() < deadline:
                await self._wait_for_one(deadline - time.monotonic())
        finally:
            for task in self._at_work:
                task.cancel()
            await asyncio.gather(*self._at_work, return_exceptions=True)

    async def _start_due_deliveries(self) -> bool:
        """Start to send what is due, and return whether anything is being sent."""
        n_sending = Counter(claim.receiver for claim in self._at_work.values())
        n_free = MAX_PARALLEL - len(self._at_work)
        for claim in await asyncio.to_thread(claim_due, self._database, n_free, n_sending, self._claim_s):
            self._at_work[asyncio.create_task(self._send(claim))] = claim
        return bool(self._at_work)

    async def _wait_for_one(self, seconds: float) -> None:
        done, _ = await asyncio.wait(self._at_work, timeout=seconds, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            claim = self._at_work.pop(task)
            if (error := task.exception()) is not None:
                # It is sent again when the claim has run out.
                _log.warning("delivery %s: %s", claim.delivery_id, error, exc_info=error)

    async def _send(self, claim: Claim) -> None:
        try:
            answer = await self._sender.send(claim.outgoing)
        except _UNSENDABLE as error:
            # Recorded as a try, so that the delivery is given up at last: the row would fail in the same way each time.
            _log.exception("delivery %s can't be sent", claim.delivery_id)
            answer = Answer(None, f"it can't be sent ({type(error).__name__})", None, 0)
        await asyncio.to_thread(note_answer, self._database, claim, answer, random.random())
        self.outcomes["delivered" if answer.is_delivered else "failed"] += 1
