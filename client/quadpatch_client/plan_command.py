"""The command `plan`: what a repair would do, without starting it.

Tested in `tests/integration/test_catalogue_commands.py`.
"""

import typer

from quadpatch_client.connection import connected, print_json
from quadpatch_client.method_options import EffortOption, MethodOption, ModelOption, RecipeOption
from quadpatch_client.options import (
    DEFAULT_URL,
    AllButLargestOption,
    BridgeOption,
    CapOption,
    HoleChoice,
    HoleOption,
    IncludeBordersOption,
    JsonOption,
    KeyOption,
    MaxDiameterOption,
    MaxPerimeterOption,
    MeshArgument,
    MethodChoice,
    QuietOption,
    RuleOption,
    SavedRuleOption,
    UrlOption,
)
from quadpatch_client.screen import Screen


def plan(  # noqa: PLR0913 - one parameter per option of the command line
    mesh: MeshArgument,
    *,
    effort: EffortOption = None,
    method: MethodOption = None,
    model: ModelOption = None,
    recipe: RecipeOption = None,
    max_diameter: MaxDiameterOption = None,
    max_perimeter: MaxPerimeterOption = None,
    all_but_largest: AllButLargestOption = False,
    hole: HoleOption = None,
    include_borders: IncludeBordersOption = False,
    cap: CapOption = None,
    rule: RuleOption = None,
    bridge: BridgeOption = None,
    saved_rule: SavedRuleOption = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
    quiet: QuietOption = False,
) -> None:
    """Say what `repair` with the same options would do: how many holes, by which model, within which limits."""
    from quadpatch_client.spec import make_spec  # noqa: PLC0415  loads the wire schema, which --help does without

    holes = HoleChoice(max_diameter, max_perimeter, all_but_largest, hole, include_borders, cap, rule, bridge)
    choice = MethodChoice(method, model, recipe=recipe, effort=effort)
    screen = Screen(quiet, as_json=as_json)
    with connected(screen, url, api_key) as client:
        make_spec("0" * 64, holes, choice, rule=saved_rule)
        with screen.transfer("uploading") as progress:
            uploaded = client.upload(mesh, progress)
        client.wait_for_mesh(uploaded.id)
        planned = client.plan(make_spec(uploaded.id, holes, choice, rule=saved_rule))
    if as_json:
        print_json(planned)
        return
    limits = planned.limits
    typer.echo(f"{mesh.name}: {planned.summary}")
    used = planned.model
    pinned = f"{used.name}@{used.version}" if used.name else used.kind
    typer.echo(f"model: {used.requested}" + (f" ({pinned})" if pinned != used.requested else ""))
    typer.echo(f"limits: {limits.time_s:,.0f} s and {limits.memory_mb:,} MiB for each attempt")
