"""Commands on what a service keeps besides meshes and jobs: `models`, `keys`; and `train`, which makes models.

Tested in `tests/integration/test_catalogue_commands.py`.
"""

import json
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from quadpatch_client.connection import connected, print_json
from quadpatch_client.errors import UsageError
from quadpatch_client.options import DEFAULT_URL, JsonOption, KeyOption, LabelOption, QuietOption, SeedOption, UrlOption
from quadpatch_client.screen import Screen
from quadpatch_client.tables import print_keys, print_models
from quadpatch_client.wording import suggestion

if TYPE_CHECKING:
    from collections.abc import Sequence

    from pydantic import BaseModel

_SCOPES = ("read", "upload", "repair", "models", "admin")
keys = typer.Typer(name="keys", help="Keys of the service: list, make, revoke. Needs a key of scope admin.")


def models(url: UrlOption = DEFAULT_URL, api_key: KeyOption = None, as_json: JsonOption = False) -> None:
    """List the models that the service knows."""
    with connected(Screen(as_json=as_json), url, api_key) as client:
        known = client.models()
    if as_json:
        print_json(known)
    else:
        print_models(_stdout(), known)


@keys.command("list")
def list_keys(url: UrlOption = DEFAULT_URL, api_key: KeyOption = None, as_json: JsonOption = False) -> None:
    """List keys, without their secrets."""
    with connected(Screen(as_json=as_json), url, api_key) as client:
        known = client.keys()
    if as_json:
        _print_list(known)
    else:
        print_keys(_stdout(), known)


@keys.command("make")
def make_key(  # noqa: PLR0913 - one parameter per option of the command line
    name: Annotated[str, typer.Argument(help="A name for people, such as 'station 4'.")],
    *,
    scope: Annotated[
        list[str] | None,
        typer.Option(
            "--scope",
            metavar="|".join(_SCOPES),
            help="What it allows; repeat for more.",
            show_default="read, upload, repair",
        ),
    ] = None,
    tenant: Annotated[str | None, typer.Option(help="Whose it is.", show_default="yours")] = None,
    days: Annotated[float | None, typer.Option(min=0.0, help="For how long it is taken.", show_default="ever")] = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
) -> None:
    """Make a key, and print it: it is shown this once."""
    from quadpatch_client.schema import Scope  # noqa: PLC0415  loads the wire schema, which --help does without

    unknown = next((word for word in scope or () if word not in _SCOPES), None)
    until = None if days is None else datetime.now(UTC) + timedelta(days=days)
    with connected(Screen(as_json=as_json), url, api_key) as client:
        if unknown is not None:
            raise UsageError(f"there is no scope {unknown!r}{suggestion(unknown, _SCOPES)}")
        made = client.create_key(name, [Scope(word) for word in scope or ()] or None, tenant, until)
    if as_json:
        print_json(made)
    else:
        typer.echo(made.key)


@keys.command("revoke")
def revoke_key(
    key: Annotated[str, typer.Argument(help="Id of the key; see `keys list`.")],
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
) -> None:
    """End a key; there is no way back."""
    screen = Screen()
    with connected(screen, url, api_key) as client:
        client.revoke_key(key)
    screen.say(f"{key}: revoked")


def train(  # noqa: PLR0913 - one parameter per option of the command line
    model: Annotated[str, typer.Argument(help="Name of the model; a version of it is made.")],
    meshes: Annotated[
        list[Path], typer.Argument(help="Scans to learn from and to judge on.", exists=True, dir_okay=False)
    ],
    *,
    atoms: Annotated[int, typer.Option(help="Atoms of the dictionary.")] = 256,
    steps: Annotated[int, typer.Option(help="Rounds of learning.")] = 15,
    default: Annotated[
        bool, typer.Option("--default-if-better", help="Make it the default where it beats the plain fill.")
    ] = False,
    seed: SeedOption = 0,
    label: LabelOption = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
    quiet: QuietOption = False,
) -> None:
    """Learn a dictionary from scans, wait for it, and say whether it is better than the plain fill."""
    from quadpatch_client.schema import NewTraining  # noqa: PLC0415  loads the wire schema, which --help does without
    from quadpatch_client.spec import in_words  # noqa: PLC0415  the same

    screen = Screen(quiet, as_json=as_json)
    with connected(screen, url, api_key) as client:
        fields = {
            "model": model,
            "options": {"atoms": atoms, "steps": steps},
            "make_default": "if_better" if default else "never",
            "seed": seed,
            "label": label or model,
        }
        with in_words():
            NewTraining.model_validate({**fields, "meshes": ["0" * 64]})
        ids = []
        for path in meshes:
            with screen.transfer("uploading") as progress:
                ids.append(client.upload(path, progress).id)
        for mesh_id in ids:
            client.wait_for_mesh(mesh_id)
        training = client.train(NewTraining.model_validate({**fields, "meshes": list(dict.fromkeys(ids))}))
        screen.say(f"training {training.id} accepted")
        with screen.repair() as on_change:
            job = client.wait(training.id, on_change)
    if as_json:
        print_json(job)
    elif job.result is not None and job.result.training is not None:
        learned = job.result.training
        screen.tell(f"{learned.model}@{learned.version}: {learned.verdict}")


def _print_list(values: "Sequence[BaseModel]") -> None:
    typer.echo(json.dumps([value.model_dump(mode="json") for value in values], indent=2))


def _stdout() -> Console:
    return Console(highlight=False)
