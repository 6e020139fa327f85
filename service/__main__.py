"""`python -m service` serves; with `openapi` it prints the OpenAPI document, with `settings` the table of settings.

With `keys` it makes, lists, rotates and revokes keys of clients, with `tenants` it sets what tenants may have.
"""

import socket
import sys
from collections.abc import Callable
from typing import cast

import uvicorn
from fastapi import FastAPI

from jobkit.errors import SettingsError
from jobkit.logs import set_up_logs
from jobkit.privacy import hide_memory
from jobkit.settings import Settings, load_settings, settings_table
from jobkit.telemetry import open_telemetry
from service import key_commands, tenant_commands
from service.app import create_app
from service.auth import check_exposure
from service.connections import ConnectionLimits, limited_protocol, raise_descriptor_limit
from service.contract.document import to_yaml
from service.malloc import return_large_buffers

# As of `uvicorn.run`.
_START_FAILED = 3
_BACKLOG = 4096
USAGE = "usage: python -m service [openapi | settings | keys | tenants]"


def main(arguments: list[str]) -> int:
    """Run one command; return the exit code: 0, 1 for wrong settings, 2 for a wrong command."""
    if arguments == ["openapi"]:
        sys.stdout.write(to_yaml(create_app(Settings.model_construct()).openapi()))
        return 0
    if arguments == ["settings"]:
        sys.stdout.write(settings_table())
        return 0
    if arguments[:1] == ["keys"]:
        return _with_settings(lambda settings: key_commands.run(arguments[1:], settings))
    if arguments[:1] == ["tenants"]:
        return _with_settings(lambda settings: tenant_commands.run(arguments[1:], settings))
    if arguments:
        sys.stderr.write(USAGE + "\n")
        return 2
    hide_memory()
    return _with_settings(_start)


def _with_settings(run: Callable[[Settings], int]) -> int:
    """Run with the settings of the environment; 1 where they are wrong."""
    try:
        return run(load_settings())
    except SettingsError as error:
        sys.stderr.write(f"quadpatch: {error}\n")
        return 1


def _start(settings: Settings) -> int:
    check_exposure(settings)
    set_up_logs(settings)
    return_large_buffers()
    _serve(create_app(settings, open_telemetry("api")), settings)
    return 0


def _serve(app: FastAPI, settings: Settings) -> None:
    limits = ConnectionLimits(raise_descriptor_limit(settings.max_connections))
    config = uvicorn.Config(
        app,
        http=limited_protocol(limits),
        ws="none",
        backlog=_BACKLOG,
        host=settings.host,
        port=settings.port,
        log_level=settings.log_level,
        # Its log lines, those of requests among them, go to the log of this process.
        log_config=None,
        # What stands in front may be trusted with the scheme, but never with the client's address.
        proxy_headers=False,
        server_header=False,
        # Requests that wait for a job's end must not hold up a restart.
        timeout_graceful_shutdown=5,
    )
    server = _Server(config)
    server.run()
    if not server.started:
        sys.exit(_START_FAILED)


class _Server(uvicorn.Server):
    """A server that ends streams and waiting as soon as it is asked to stop; it would wait for them otherwise."""

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Stop serving."""
        services = cast(FastAPI, self.config.app).state.services
        for waiting_requests in (services.streams, services.job_waiters, services.mesh_waiters, services.model_waiters):
            waiting_requests.close()
        await super().shutdown(sockets)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
