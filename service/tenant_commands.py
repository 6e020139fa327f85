"""`python -m service tenants`: list tenants, show one, and set what it may have, without HTTP.

Tested in `tests/service/test_main.py`.
"""

import argparse
import re
import sys
from collections.abc import Sequence
from typing import Any

from pydantic import ValidationError

from jobkit.access.tenants import Tenants
from jobkit.database.quotas import default_quotas
from jobkit.database.session import Database
from jobkit.errors import DatabaseUnavailableError, OperatorTenantError, TenantNotFoundError
from jobkit.settings import Settings
from quadpatch_client.schema import Quotas, Tenant, TenantChanges, TenantWithUse
from quadpatch_rules.ids import TENANT
from quadpatch_rules.text import printable
from service.command_line import CommandParser, print_columns

_OPTIONS = {name: "--" + name.replace("_", "-") for name in Quotas.model_fields}
_USE = {"jobs_at_once": "jobs_at_work"}
_MISSING = "-"


def run(arguments: Sequence[str], settings: Settings) -> int:
    """Run one command on the database of the settings; return the exit code: 0, 1 where it fails, 2 for wrong usage."""
    options = _parser().parse_args(arguments)
    database = Database(settings.effective_database_url).limited(default_quotas(settings))
    try:
        database.migrate()
        _run(options, Tenants(database))
    except (ValidationError, ValueError) as error:
        sys.stderr.write(f"quadpatch: {printable(str(error))}\n")
        return 2
    except (TenantNotFoundError, OperatorTenantError, DatabaseUnavailableError) as error:
        sys.stderr.write(f"quadpatch: {error}\n")
        return 1
    finally:
        database.close()
    return 0


def _run(options: argparse.Namespace, tenants: Tenants) -> None:
    if options.command == "show":
        _print_one(tenants.get(options.name))
    elif options.command == "set":
        _print_one(tenants.change(options.name, TenantChanges(**_changes(options))))
    else:
        _print_all(tenants.list_all().items)


def _changes(options: argparse.Namespace) -> dict[str, Any]:
    given = {name: getattr(options, name) for name in _OPTIONS if getattr(options, name) is not None}
    changes: dict[str, Any] = {name: None if value == "default" else value for name, value in given.items()}
    return changes if options.disabled is None else {**changes, "disabled": options.disabled}


def _print_one(tenant: TenantWithUse) -> None:
    rows = [("", "LIMIT", "SET", "USED")]
    for name in Quotas.model_fields:
        used = getattr(tenant.use, _USE.get(name, name), _MISSING)
        rows.append((name, _limit(tenant, name), "yes" if name in tenant.own_quotas else "default", str(used)))
    sys.stdout.write(f"{tenant.name}{', disabled' if tenant.disabled else ''}\n")
    print_columns(rows)


def _print_all(tenants: Sequence[Tenant]) -> None:
    rows = [("TENANT", *(name.upper().replace("_", " ") for name in _OPTIONS), "STATE")]
    for tenant in tenants:
        limits = [_limit(tenant, name) for name in _OPTIONS]
        rows.append((tenant.name, *limits, "disabled" if tenant.disabled else "valid"))
    print_columns(rows)


def _limit(tenant: Tenant, name: str) -> str:
    limit = getattr(tenant.quotas, name)
    return str(limit) if limit else "no limit"


def _quota(text: str) -> int | str:
    if text == "default":
        return text
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number, nor 'default'")
    return int(text)


def _name(text: str) -> str:
    if re.fullmatch(TENANT, text) is None:
        raise argparse.ArgumentTypeError(f"{printable(text)!r} is no name of a tenant")
    return text


def _parser() -> argparse.ArgumentParser:
    parser = CommandParser(
        prog="python -m service tenants",
        description="Tenants and what they may have. Running processes know a change within two seconds.",
    )
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("list", help="list tenants and their limits")
    commands.add_parser("show", help="show one, with what it has").add_argument("name", type=_name)
    change = commands.add_parser("set", help="set limits of one; it is made where it is not there")
    change.add_argument("name", type=_name)
    for name, option in _OPTIONS.items():
        help_text = f"most {name.replace('_', ' ')}; 0: no limit, default: that of the settings"
        change.add_argument(option, dest=name, type=_quota, metavar="N", help=help_text)
    state = change.add_mutually_exclusive_group()
    state.add_argument("--disable", dest="disabled", action="store_true", default=None, help="refuse its keys")
    state.add_argument("--enable", dest="disabled", action="store_false", help="take them again")
    return parser
