"""The commands `rules`, `rules show` and `rules save`.

Tested in `tests/integration/test_catalogue_commands.py`.
"""

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from quadpatch_client.connection import connected, print_json
from quadpatch_client.errors import UsageError
from quadpatch_client.options import DEFAULT_URL, JsonOption, KeyOption, UrlOption
from quadpatch_client.outputs import is_stream
from quadpatch_client.screen import Screen
from quadpatch_client.tables import print_rules

if TYPE_CHECKING:
    from quadpatch_client.schema import RuleContent

# Of a file that a person writes; the service takes no more.
_MOST_BYTES = 1 << 20
rules = typer.Typer(name="rules", help="Rules that the service keeps: list, show, save.", invoke_without_command=True)


@rules.callback()
def list_rules(
    context: typer.Context, url: UrlOption = DEFAULT_URL, api_key: KeyOption = None, as_json: JsonOption = False
) -> None:
    """List the rules that the service keeps; --saved-rule of other commands names one."""
    if context.invoked_subcommand is not None:
        return
    with connected(Screen(as_json=as_json), url, api_key) as client:
        known = client.rules()
    if as_json:
        typer.echo(json.dumps([rule.model_dump(mode="json") for rule in known], indent=2))
    else:
        print_rules(Console(highlight=False), known)


@rules.command("show")
def show_rule(
    rule: Annotated[str, typer.Argument(help="name, or name@version.")],
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
) -> None:
    """Print what a rule says, as JSON that `rules save` takes; with --json the whole rule."""
    with connected(Screen(as_json=as_json), url, api_key) as client:
        found = client.rule(rule)
    if as_json:
        print_json(found)
    else:
        typer.echo(found.content.model_dump_json(indent=2, exclude_defaults=True))


@rules.command("save")
def save_rule(
    name: Annotated[str, typer.Argument(help="A name; one that is there gets its next version.")],
    file: Annotated[Path, typer.Argument(metavar="FILE", help="What it says, as JSON; -: standard input.")],
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
) -> None:
    """Save a rule, such as {"holes": {"max_diameter": 20}, "acceptance": {"min_confidence": 0.8}}."""
    screen = Screen(as_json=as_json)
    with connected(screen, url, api_key) as client:
        saved = client.save_rule(name, _content(file))
    if as_json:
        print_json(saved)
    else:
        screen.tell(f"saved {saved.name}@{saved.version}")


def _content(file: Path) -> "RuleContent":
    """Read what a rule is to say; UsageError where it is no rule."""
    from quadpatch_client.schema import RuleContent  # noqa: PLC0415  loads the wire schema, which --help does without
    from quadpatch_client.spec import in_words  # noqa: PLC0415  the same

    try:
        text = sys.stdin.read(_MOST_BYTES + 1) if is_stream(file) else file.read_text("utf-8")
        values = json.loads(text)
    except (OSError, ValueError) as error:
        raise UsageError(f"{file} can't be read as JSON: {error}") from error
    if not isinstance(values, dict) or len(text) > _MOST_BYTES:
        raise UsageError(f'{file} holds no rule: it has to be an object, such as {{"holes": {{"max_diameter": 20}}}}')
    with in_words():
        return RuleContent.model_validate(values)
