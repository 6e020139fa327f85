"""HEAD wherever GET is (RFC 9110, 9.3.2): the same request, answered without its content."""

from starlette.types import ASGIApp, Message, Receive, Scope, Send

_IS_HEAD = "quadpatch.is_head"


def is_head(scope: Scope) -> bool:
    """Return whether what a route sees as GET is a HEAD, so that the route need not open what it would send."""
    return bool(scope.get(_IS_HEAD, False))


class HeadMiddleware:
    """Lets the routes see a GET, and leaves out the content of the answer."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on."""
        if scope["type"] != "http" or scope["method"] != "HEAD":
            await self._app(scope, receive, send)
            return
        # A copy: the server looks into its own to know whether content may follow.
        get_scope = {**scope, "method": "GET", _IS_HEAD: True}
        has_ended = False

        async def send_head(message: Message) -> None:
            nonlocal has_ended
            if has_ended or message["type"] != "http.response.start":
                return
            has_ended = True
            scope["route"] = get_scope.get("route")
            await send(message)
            await send({"type": "http.response.body", "body": b"", "more_body": False})

        async def receive_until_ended() -> Message:
            # A stream ends when its client disconnects, and a file is read no further.
            return {"type": "http.disconnect"} if has_ended else await receive()

        await self._app(get_scope, receive_until_ended, send_head)
