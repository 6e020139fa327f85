"""`python -m service` serves; `python -m service openapi` prints the document; `settings` prints what can be set."""

import logging
import sys

import uvicorn

from jobkit.errors import SettingsError
from jobkit.settings import Settings, load_settings, settings_table
from service.app import create_app
from service.document import to_yaml

USAGE = "usage: python -m service [openapi | settings]"


def main(arguments: list[str]) -> int:
    """Run one command; return the exit code: 0, 1 for wrong settings, 2 for a wrong command."""
    if arguments == ["openapi"]:
        sys.stdout.write(to_yaml(create_app(Settings.model_construct()).openapi()))
        return 0
    if arguments == ["settings"]:
        sys.stdout.write(settings_table())
        return 0
    if arguments:
        sys.stderr.write(USAGE + "\n")
        return 2
    try:
        settings = load_settings()
        app = create_app(settings)
    except SettingsError as error:
        sys.stderr.write(f"quadpatch: {error}\n")
        return 1
    logging.basicConfig(level=settings.log_level.upper(), format="%(asctime)s %(levelname)s %(name)s: %(message)s")
    uvicorn.run(
        app,
        host=settings.host,
        port=settings.port,
        log_level=settings.log_level,
        # What stands in front may be trusted with the scheme, but never with the client's address.
        proxy_headers=False,
        server_header=False,
        # Requests that wait for a job's end must not hold up a restart.
        timeout_graceful_shutdown=5,
    )
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
