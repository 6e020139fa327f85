"""`restore` gives missing vertices a position.

Tested in `tests/quadpatch/cli/test_tasks.py`.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from quadpatch.cli.flags import (
    Html,
    Output,
    Overlap,
    Overwrite,
    PatchLength,
    PatchPreset,
    Preview,
    Quiet,
    Report,
    Resolution,
    Seed,
    Source,
    Unit,
)
from quadpatch.cli.tasks import Files, given, run_task
from quadpatch.progress import Progress

if TYPE_CHECKING:
    from quadpatch.tasks.result import TaskResult

Base = Literal["mesh", "poisson"]

_NAN, _PROPERTY = "nan", "property:"


def restore(  # noqa: PLR0913, PLR0917  one argument per flag
    source: Source,
    output: Output,
    missing: Annotated[
        str,
        typer.Option(
            metavar="PROPERTY|nan|FILE",
            help="Which vertices are missing: those that a vertex property of a PLY marks, those whose coordinates are "
            "NaN, or those whose numbers a text, JSON or npy file lists. property:NAME where a file has that name.",
        ),
    ],
    coarse: Annotated[
        Path | None, typer.Option(metavar="MESH", help="A coarse mesh of the same object in the same place.")
    ] = None,
    base: Annotated[
        Base,
        typer.Option(
            help="Where missing vertices may lie: as the mesh's own edges say, or on a Poisson surface as well."
        ),
    ] = "mesh",
    model: Annotated[
        str,
        typer.Option(
            help="self (learn a dictionary from this mesh), smooth (geometry only), a shipped model, or a model file."
        ),
    ] = "self",
    report: Report = None,
    preview: Preview = None,
    html: Html = None,
    overwrite: Overwrite = False,
    patch_length: PatchLength = None,
    resolution: Resolution = None,
    overlap: Overlap = None,
    preset: PatchPreset = None,
    length_unit: Unit = None,
    seed: Seed = 0,
    quiet: Quiet = False,
) -> None:
    """Give missing vertices of a scan a position; all others keep their bits."""
    which = read_missing(missing)

    def task(progress: Progress) -> "TaskResult":
        from quadpatch.restoration.restore import RestoreOptions  # noqa: PLC0415  slow to load
        from quadpatch.tasks.restore import restore_file  # noqa: PLC0415

        patches = {"length": patch_length, "resolution": resolution, "overlap": overlap, "preset": preset}
        options = RestoreOptions.from_dict(given(patches=patches, seed=seed, base=base, length_unit=length_unit))
        return restore_file(source, output, which, model, options, progress, coarse=coarse)

    inputs = [path for path in (which, coarse) if isinstance(path, Path)]
    run_task(Files(source, output, report, preview, overwrite, inputs, html), task, restored, quiet)


def read_missing(text: str) -> str | Path:
    """Read `--missing`: `nan`, `property:NAME`, or the path of a file that is there; any other word is a property."""
    if text == _NAN or text.startswith(_PROPERTY):
        return text
    return Path(text) if Path(text).exists() else _PROPERTY + text


def restored(report: dict[str, Any], unit: str) -> str:
    """Say how many vertices got a position."""
    error = report["expected_error"]["percentile_95"]
    bound = "" if error is None else f", 95 of 100 of them expected to be off by no more than {error:.3g} {unit}"
    counts = report["vertices"]
    return f"{counts['restored']:,} of {counts['missing']:,} missing vertices got a position{bound}; all others stay"
