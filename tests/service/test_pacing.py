import asyncio

from starlette.types import Message, Receive, Scope, Send

from service.pacing import Pacer, PacingMiddleware
from tests.service.rounds import most_in_a_round

N = 100


def test_requests_that_come_at_once_go_on_one_in_each_round() -> None:
    assert asyncio.run(most_in_a_round(Pacer().wait_turn, N)) == 1


def test_a_cancelled_request_holds_up_no_others_and_the_queue_starts_again() -> None:
    async def run() -> None:
        pacer = Pacer()
        for _ in range(2):
            tasks = [asyncio.create_task(pacer.wait_turn()) for _ in range(3)]
            await asyncio.sleep(0)
            tasks[0].cancel()
            tasks[1].cancel()
            await asyncio.wait(tasks)
            assert [task.cancelled() for task in tasks] == [True, True, False]

    asyncio.run(run())


def test_healthz_is_answered_before_requests_that_came_at_once() -> None:
    async def run() -> None:
        served: list[str] = []

        async def app(scope: Scope, receive: Receive, send: Send) -> None:
            served.append(scope["path"])

        async def receive() -> dict[str, object]:
            return {}

        async def send(message: object) -> None:
            return None

        middleware = PacingMiddleware(app, Pacer())
        paths = ["/v1/jobs"] * N + ["/healthz"]
        await asyncio.gather(*(middleware({"type": "http", "path": path}, receive, send) for path in paths))
        assert served.index("/healthz") == 0
        assert len(served) == N + 1

    asyncio.run(run())


def test_disconnects_at_once_are_delivered_one_in_each_round() -> None:
    async def run() -> int:
        begun, has_left = list[str](), asyncio.Event()

        async def app(scope: Scope, receive: Receive, send: Send) -> None:
            begun.append(scope["path"])
            if len(begun) == N:
                has_left.set()
            assert (await receive())["type"] == "http.disconnect"

        async def receive() -> Message:
            await has_left.wait()
            return {"type": "http.disconnect"}

        async def send(message: Message) -> None:
            return None

        middleware = PacingMiddleware(app, Pacer())
        return await most_in_a_round(lambda: middleware({"type": "http", "path": "/v1/meshes"}, receive, send), N)

    assert asyncio.run(run()) == 1
