"""`python -m service keys`: make, list, rotate and revoke keys, without HTTP: for the first key, and for the operator.

Tested in `tests/service/test_main.py`.
"""

import argparse
import contextlib
import sys
from collections.abc import Sequence
from datetime import datetime

from pydantic import ValidationError

from jobkit.access.keys import Keys
from jobkit.database.session import Database
from jobkit.errors import DatabaseUnavailableError, KeyNotFoundError, KeyRevokedError
from jobkit.settings import Settings
from quadpatch_client.schema import Key, KeyWithSecret, NewKey, Scope
from quadpatch_rules.text import printable
from service.auth import shown_database
from service.command_line import CommandParser, print_columns


def run(arguments: Sequence[str], settings: Settings) -> int:
    """Run one command on the database of the settings; return the exit code: 0, 1 where it fails, 2 for wrong usage."""
    options = _parser().parse_args(arguments)
    database = Database(settings.effective_database_url)
    try:
        database.migrate()
        _run(options, Keys(database), shown_database(settings))
    except ValidationError as error:
        details = error.errors(include_input=False, include_url=False)
        sys.stderr.write("".join(f"quadpatch: {detail['loc'][0]}: {detail['msg']}\n" for detail in details))
        return 2
    except (KeyNotFoundError, KeyRevokedError, DatabaseUnavailableError) as error:
        sys.stderr.write(f"quadpatch: {error}\n")
        return 1
    finally:
        database.close()
    return 0


def _run(options: argparse.Namespace, keys: Keys, database: str) -> None:
    if options.command == "create":
        new = NewKey(
            name=options.name,
            tenant=options.tenant,
            scopes=[Scope(name) for name in options.scope or ("read", "upload", "repair")],
            expires_at=options.expires,
            requests_per_minute=options.requests_per_minute,
        )
        _print_new(keys.create(new)[0], database)
    elif options.command == "rotate":
        _print_new(keys.rotate(options.id)[0], database)
    elif options.command == "revoke":
        keys.revoke(options.id)
    else:
        _print_table(keys.list_all().items)


def _print_new(key: KeyWithSecret, database: str) -> None:
    rights = ", ".join(key.scopes)
    sys.stderr.write(f"{key.id}, {key.name}, tenant {key.tenant}: {rights}; written to {database}\n")
    sys.stderr.write("the key, shown this once:\n")
    sys.stdout.write(f"{key.key}\n")


def _print_table(keys: Sequence[Key]) -> None:
    rows = [("ID", "TENANT", "NAME", "SCOPES", "LAST USED", "STATE")]
    rows += [(key.id, key.tenant, printable(key.name), ",".join(key.scopes), _use(key), _state(key)) for key in keys]
    print_columns(rows)


def _use(key: Key) -> str:
    return _day(key.used_at) or "never"


def _state(key: Key) -> str:
    if key.revoked_at is not None:
        return f"revoked {_day(key.revoked_at)}"
    return f"until {_day(key.expires_at)}" if key.expires_at else "valid"


def _day(moment: datetime | None) -> str:
    return "" if moment is None else moment.strftime("%Y-%m-%d")


def _moment(text: str) -> datetime:
    moment = None
    with contextlib.suppress(ValueError):
        moment = datetime.fromisoformat(text)
    if moment is None or moment.tzinfo is None:
        raise argparse.ArgumentTypeError(f"{text!r} is no moment with a zone, like 2027-01-31T00:00:00+00:00")
    return moment


def _parser() -> argparse.ArgumentParser:
    parser = CommandParser(
        prog="python -m service keys",
        description="Keys of clients. Requests without one are refused once the first is made.",
    )
    commands = parser.add_subparsers(dest="command", required=True)
    create = commands.add_parser("create", help="make a key, and print it")
    create.add_argument("name", help="for people, such as 'station 4'")
    create.add_argument("--tenant", default="default", help="whose meshes and jobs it reaches (default: %(default)s)")
    names = [scope.value for scope in Scope]
    create.add_argument("--scope", action="append", choices=names, help="may be repeated (default: read upload repair)")
    create.add_argument("--expires", type=_moment, help="when it ends, like 2027-01-31T00:00:00+00:00")
    create.add_argument(
        "--requests-per-minute", type=int, help="what it may send besides the limit of its tenant (default: no limit)"
    )
    commands.add_parser("list", help="list keys, without what clients send")
    for name, words in (("rotate", "print a new key; the old one is taken for a day more"), ("revoke", "end a key")):
        commands.add_parser(name, help=words).add_argument("id", help="of the key, like key_01jd…")
    return parser
