"""The command `watch`.

Tested in `tests/integration/test_watch.py`.
"""

import time
from typing import Annotated

import typer

from quadpatch_client.connection import connected
from quadpatch_client.folder_files import remove_partial_files
from quadpatch_client.folder_options import (
    FolderArgument,
    FolderHtmlOption,
    ParallelOption,
    WhereOption,
    job_options,
)
from quadpatch_client.folder_watch import STATE, FolderWatch
from quadpatch_client.journal import Journal, one_client_alone
from quadpatch_client.method_options import EffortOption, MethodOption, ModelOption
from quadpatch_client.options import (
    DEFAULT_URL,
    CapOption,
    HoleChoice,
    IncludeBordersOption,
    KeyOption,
    LabelOption,
    LengthUnitOption,
    MaxDiameterOption,
    MaxPerimeterOption,
    MethodChoice,
    PriorityOption,
    QuietOption,
    RuleOption,
    SavedRuleOption,
    SeedOption,
    UrlOption,
)
from quadpatch_client.screen import Screen

# A line that drops for a moment is waited for within a request; the folder waits for a service that is away.
_PATIENCE_S = 30.0
_LOOK_S = 0.5


def watch(  # noqa: PLR0913 - one parameter per option of the command line
    folder: FolderArgument,
    *,
    once: Annotated[bool, typer.Option("--once", help="Repair what lies there, and end.")] = False,
    settle: Annotated[
        float, typer.Option(min=0.0, help="Take a file once it has not changed for so many seconds.")
    ] = 2.0,
    where: WhereOption = None,
    parallel: ParallelOption = 2,
    effort: EffortOption = None,
    method: MethodOption = None,
    model: ModelOption = None,
    max_diameter: MaxDiameterOption = None,
    max_perimeter: MaxPerimeterOption = None,
    include_borders: IncludeBordersOption = False,
    cap: CapOption = None,
    rule: RuleOption = None,
    saved_rule: SavedRuleOption = None,
    seed: SeedOption = 0,
    label: LabelOption = None,
    priority: PriorityOption = None,
    length_unit: LengthUnitOption = None,
    html: FolderHtmlOption = False,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    quiet: QuietOption = False,
) -> None:
    """Repair every mesh that is dropped into a folder; result and report appear beside it. Ctrl-C ends it.

    While the service is away, files wait. What can't be repaired is moved to DIR/failed, with the reason.
    """
    screen = Screen(quiet)
    with connected(screen, url, api_key, _PATIENCE_S) as client:
        options = job_options(
            HoleChoice(max_diameter, max_perimeter, False, None, include_borders, cap, rule),
            MethodChoice(method, model, effort=effort),
            {
                "seed": seed,
                "label": label,
                "priority": priority or "normal",
                "length_unit": length_unit,
                "rule": saved_rule,
                "format": None,
            },
            where,
            *(["html_report"] if html else []),
        )
        (folder / STATE).mkdir(exist_ok=True)
        with one_client_alone(folder / STATE), Journal(folder / STATE / "journal.jsonl") as journal:
            remove_partial_files(folder)
            work = FolderWatch(client, folder, options, journal, parallel, settle, screen.say, html, not once)
            screen.say(f"watching {folder}; end with Ctrl-C" if not once else f"repairing what lies in {folder}")
            work.look()
            while not (once and work.is_idle):
                time.sleep(_LOOK_S)
                work.look()
