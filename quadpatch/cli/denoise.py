"""`denoise` takes noise from the vertices of a scan.

Tested in `tests/quadpatch/cli/test_tasks.py`.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

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
from quadpatch.cli.tasks import Files, given, run_task, vertices
from quadpatch.errors import OptionError
from quadpatch.progress import Progress

if TYPE_CHECKING:
    from quadpatch.tasks.result import TaskResult


def denoise(  # noqa: PLR0913, PLR0917  one argument per flag
    source: Source,
    output: Output,
    reference: Annotated[
        Path | None, typer.Option(metavar="CLEAN", help="A clean scan of a similar object to learn from.")
    ] = None,
    noise: Annotated[
        float | None,
        typer.Option(help="Standard deviation of the noise (mesh units).", show_default="estimated"),
    ] = None,
    max_shift: Annotated[
        float | None,
        typer.Option(help="Move no vertex farther than this (mesh units).", show_default="follows from the noise"),
    ] = None,
    region: Annotated[
        tuple[float, float, float, float, float, float] | None,
        typer.Option(
            metavar="X Y Z X Y Z",
            help="Move only vertices in this box, its smallest and its largest corner (mesh units).",
            show_default="all",
        ),
    ] = None,
    region_property: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Move only vertices at which this vertex property of the PLY is not 0."),
    ] = None,
    model: Annotated[
        str,
        typer.Option(
            help="self (learn a dictionary from this mesh, or from CLEAN), smooth (no dictionary), a shipped "
            "dictionary, or a dictionary's file."
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
    """Take noise from the vertices of a scan; their order, triangles and attributes stay."""

    def task(progress: Progress) -> "TaskResult":
        from quadpatch.denoising.options import DenoiseOptions  # noqa: PLC0415  slow to load
        from quadpatch.tasks.denoise import denoise_file  # noqa: PLC0415

        patches = {"length": patch_length, "resolution": resolution, "overlap": overlap, "preset": preset}
        if region is not None and region_property is not None:
            raise OptionError("--region and --region-property are two ways to say one thing: name one of them")
        box = None if region is None else {"min": list(region[:3]), "max": list(region[3:])}
        values = given(
            noise=noise,
            max_shift=max_shift,
            region=box or region_property,
            patches=patches,
            seed=seed,
            length_unit=length_unit,
        )
        return denoise_file(source, output, model, DenoiseOptions.from_dict(values), progress, reference)

    inputs = [reference] if reference else []
    run_task(Files(source, output, report, preview, overwrite, inputs, html), task, denoised, quiet)


def denoised(report: dict[str, Any], unit: str) -> str:
    """Say how many vertices moved, and how far."""
    n_moved = report["moved_vertices"]
    text = f"{vertices(n_moved)} {'was' if n_moved == 1 else 'were'} moved"
    text += f", 95 of 100 of them by no more than {report['shift_95']:.3g} {unit}, none by more than "
    text += f"{report['shift_max']:.3g}"
    source = "estimated" if report["noise_estimated"] else "given"
    return f"{text}; the noise is {report['noise']:.3g} {unit} ({source})"
