import asyncio

from starlette.types import Message, Receive, Scope, Send

from service.turns import Turns, TurnsMiddleware
from tests.service.rounds import most_in_a_round

N = 100


def test_those_that_come_at_once_go_on_one_in_each_round() -> None:
    assert asyncio.run(most_in_a_round(Turns().take, N)) == 1


def test_who_leaves_the_line_holds_up_no_others_and_the_line_starts_again() -> None:
    async def run() -> None:
        turns = Turns()
        for _ in range(2):
            tasks = [asyncio.create_task(turns.take()) for _ in range(3)]
            await asyncio.sleep(0)
            tasks[0].cancel()
            tasks[1].cancel()
            await asyncio.wait(tasks)
            assert [task.cancelled() for task in tasks] == [True, True, False]

    asyncio.run(run())


def test_a_sign_of_life_is_given_before_those_that_came_in_a_crowd() -> None:
    async def run() -> None:
        served: list[str] = []

        async def app(scope: Scope, receive: Receive, send: Send) -> None:
            served.append(scope["path"])

        async def receive() -> dict[str, object]:
            return {}

        async def send(message: object) -> None:
            return None

        line = TurnsMiddleware(app, Turns())
        paths = ["/v1/jobs"] * N + ["/healthz"]
        await asyncio.gather(*(line({"type": "http", "path": path}, receive, send) for path in paths))
        assert served.index("/healthz") == 0
        assert len(served) == N + 1

    asyncio.run(run())


def test_those_whose_clients_leave_at_once_hear_of_it_one_after_the_other() -> None:
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

        line = TurnsMiddleware(app, Turns())
        return await most_in_a_round(lambda: line({"type": "http", "path": "/v1/meshes"}, receive, send), N)

    assert asyncio.run(run()) == 1
