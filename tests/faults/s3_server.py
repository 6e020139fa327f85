"""`python -m tests.faults.s3_server HOST PORT REFUSAL`: moto's S3 in a process of its own.

As long as the file REFUSAL exists every request is answered with 503, as S3 does under too many requests.
"""

import logging
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from moto.moto_server.werkzeug_app import DomainDispatcherApplication, create_backend_app
from werkzeug.serving import run_simple

_BODY = b"<Error><Code>ServiceUnavailable</Code><Message>Please reduce your request rate.</Message></Error>"
Application = Callable[[dict[str, Any], Callable[..., Any]], Iterable[bytes]]


def refusing(application: Application, refusal: Path) -> Application:
    """Wrap an application so that it refuses requests while the file exists."""

    def answer(environ: dict[str, Any], start_response: Callable[..., Any]) -> Iterable[bytes]:
        if not refusal.exists():
            return application(environ, start_response)
        environ["wsgi.input"].read(int(environ.get("CONTENT_LENGTH") or 0))
        start_response("503 Service Unavailable", [("Content-Type", "application/xml")])
        return [_BODY]

    return answer


def main(arguments: list[str]) -> None:
    """Serve until killed."""
    logging.getLogger("werkzeug").setLevel(logging.ERROR)
    application = refusing(DomainDispatcherApplication(create_backend_app), Path(arguments[2]))
    run_simple(arguments[0], int(arguments[1]), application, threaded=True)


if __name__ == "__main__":
    main(sys.argv[1:])
