"""`encode` compresses the surface of a scan, `decode` brings it back.

Tested in `tests/quadpatch/cli/test_tasks.py`.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from quadpatch.cli.flags import Html, Model, Output, PatchLength, Preview, Quiet, Report, Resolution, Seed, Source, Unit
from quadpatch.cli.tasks import Files, given, run_task, vertices
from quadpatch.progress import Progress

if TYPE_CHECKING:
    from quadpatch.tasks.result import TaskResult


def encode(  # noqa: PLR0913, PLR0917  one argument per flag
    source: Source,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="OUT.qpz", help="-: standard output.")],
    max_error: Annotated[
        float, typer.Option(help="How far the decoded surface may lie from the scan at most, and back (mesh units).")
    ],
    keep_connectivity: Annotated[
        bool, typer.Option("--keep-connectivity", help="Store the triangles as well: every vertex comes back.")
    ] = False,
    model: Model = "self",
    report: Report = None,
    preview: Preview = None,
    html: Html = None,
    patch_length: PatchLength = None,
    resolution: Resolution = None,
    length_unit: Unit = None,
    seed: Seed = 0,
    quiet: Quiet = False,
) -> None:
    """Compress the surface of a scan into a .qpz file, within an error that is proved."""

    def task(progress: Progress) -> "TaskResult":
        from quadpatch.compression.encode import EncodeOptions  # noqa: PLC0415  slow to load
        from quadpatch.tasks.encode import encode_file  # noqa: PLC0415

        patches = {"length": patch_length, "resolution": resolution}
        values = given(
            max_error=max_error,
            keep_connectivity=keep_connectivity,
            patches=patches,
            seed=seed,
            length_unit=length_unit,
        )
        return encode_file(source, output, model, EncodeOptions.from_dict(values), progress)

    run_task(Files(source, output, report, preview, html=html), task, encoded, quiet)


def decode(  # noqa: PLR0913, PLR0917  one argument per flag
    source: Annotated[Path, typer.Argument(metavar="IN.qpz", help="An encoded mesh.")],
    output: Output,
    model: Annotated[
        str | None,
        typer.Option(help="The dictionary's file, if the mesh was encoded over one that is not shipped."),
    ] = None,
    report: Report = None,
    preview: Preview = None,
    html: Html = None,
    quiet: Quiet = False,
) -> None:
    """Bring back the surface of a .qpz file."""

    def task(progress: Progress) -> "TaskResult":
        from quadpatch.tasks.decode import decode_file  # noqa: PLC0415  slow to load

        return decode_file(source, output, model, progress)

    run_task(Files(source, output, report, preview, html=html), task, decoded, quiet)


def encoded(report: dict[str, Any], unit: str) -> str:
    """Say what a file takes, and what was proved of it."""
    errors = report["max_error"]
    largest = max(errors["true_to_decoded"], errors["decoded_to_true"])
    text = f"{vertices(report['source']['vertices'])} encoded in {report['bytes']:,} bytes"
    text += f" ({report['ratio']:.3g} times smaller than float32 positions and int32 triangles): decoded again, the "
    return f"{text}surface is at most {largest:.3g} {unit} from the scan, {errors['promised']:.3g} are allowed"


def decoded(report: dict[str, Any], unit: str) -> str:
    """Say what came out of a file."""
    mesh = report["decoded"]
    kind = "in the order of the scan" if report["keeps_connectivity"] else "as a regular mesh over the quads"
    text = f"{report['source']['bytes']:,} bytes decoded to {vertices(mesh['vertices'])} and {mesh['triangles']:,} "
    return f"{text}triangles, {kind}, at most {report['max_error']:.3g} {unit} from the scan"
