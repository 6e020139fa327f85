"""Commands for the tasks besides filling holes: `restore`, `denoise`, `encode` and `decode`."""

from pathlib import Path
from typing import Annotated, Any

import typer

from quadpatch_client.errors import UsageError
from quadpatch_client.missing_vertices import read_missing
from quadpatch_client.options import (
    DEFAULT_URL,
    AgainOption,
    FormatOption,
    HtmlOption,
    JsonOption,
    KeyOption,
    LabelOption,
    MeshArgument,
    MethodChoice,
    OutputOption,
    OverwriteOption,
    PdfOption,
    PreviewOption,
    QuietOption,
    ReportOption,
    SeedOption,
    TimeoutOption,
    UrlOption,
)
from quadpatch_client.outputs import is_stream
from quadpatch_client.repairing import Task, format_of
from quadpatch_client.running import Connection, run
from quadpatch_rules.option_words import RestorationBase

_SUFFIX = ".qpz"
ModelOption = Annotated[
    str | None,
    typer.Option(
        help="name@version, an alias, or 'self': learned from the mesh itself; 'smooth' restores and denoises by "
        "geometry alone.",
        show_default="self",
    ),
]
EncodedArgument = Annotated[
    Path, typer.Argument(metavar="MESH", help="A .qpz file.", exists=True, dir_okay=False, readable=True)
]


def restore(  # noqa: PLR0913 - one parameter per option of the command line
    mesh: MeshArgument,
    *,
    output: OutputOption,
    missing: Annotated[
        str,
        typer.Option(
            metavar="PROPERTY|nan|FILE",
            help="Which vertices are missing: those that a vertex property of a PLY marks, those whose coordinates "
            "are NaN, or those whose numbers a text or JSON file lists.",
        ),
    ],
    base: Annotated[
        RestorationBase,
        typer.Option(help="What says where they lie: the triangles around them, or a Poisson surface as well."),
    ] = "mesh",
    model: ModelOption = None,
    seed: SeedOption = 0,
    label: LabelOption = None,
    format_: FormatOption = None,
    report: ReportOption = None,
    preview: PreviewOption = None,
    html: HtmlOption = None,
    pdf: PdfOption = None,
    overwrite: OverwriteOption = False,
    again: AgainOption = False,
    timeout: TimeoutOption = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
    quiet: QuietOption = False,
) -> None:
    """Give missing vertices of a scan a position; all others keep their bits."""

    def task() -> Task:
        options = {"missing": read_missing(missing), "base": base}
        rest = {"task": "restore", "restore": options, "seed": seed, "label": label}
        rest["output"] = _output(output, format_, preview, html or pdf)
        return Task(
            mesh,
            output,
            method=_method(model),
            rest=rest,
            report=report,
            preview=preview,
            html=html,
            pdf=pdf,
            timeout_s=timeout,
            may_overwrite=overwrite,
            again=again,
        )

    run(task, Connection(url, api_key, quiet, as_json))


def denoise(  # noqa: PLR0913 - one parameter per option of the command line
    mesh: MeshArgument,
    *,
    output: OutputOption,
    reference: Annotated[
        Path | None,
        typer.Option(
            help="A clean scan of a similar object to learn from.", exists=True, dir_okay=False, readable=True
        ),
    ] = None,
    noise: Annotated[
        float | None,
        typer.Option(help="Standard deviation of the noise, in mesh units.", show_default="estimated"),
    ] = None,
    max_shift: Annotated[
        float | None,
        typer.Option(help="Move no vertex farther than this, in mesh units.", show_default="follows from the noise"),
    ] = None,
    region: Annotated[
        tuple[float, float, float, float, float, float] | None,
        typer.Option(
            metavar="X Y Z X Y Z",
            help="Move only vertices in this box, its smallest and its largest corner, in mesh units.",
            show_default="all",
        ),
    ] = None,
    model: ModelOption = None,
    seed: SeedOption = 0,
    label: LabelOption = None,
    format_: FormatOption = None,
    report: ReportOption = None,
    preview: PreviewOption = None,
    html: HtmlOption = None,
    pdf: PdfOption = None,
    overwrite: OverwriteOption = False,
    again: AgainOption = False,
    timeout: TimeoutOption = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
    quiet: QuietOption = False,
) -> None:
    """Take noise from the vertices of a scan; their order, triangles and attributes stay."""

    def task() -> Task:
        box = None if region is None else {"kind": "box", "min": list(region[:3]), "max": list(region[3:])}
        given = {"noise": noise, "max_shift": max_shift, "region": box}
        options = {name: value for name, value in given.items() if value is not None}
        rest = {"task": "denoise", "denoise": options, "seed": seed, "label": label}
        rest["output"] = _output(output, format_, preview, html or pdf)
        return Task(
            mesh,
            output,
            method=_method(model),
            rest=rest,
            report=report,
            preview=preview,
            html=html,
            pdf=pdf,
            timeout_s=timeout,
            may_overwrite=overwrite,
            again=again,
            reference=reference,
        )

    run(task, Connection(url, api_key, quiet, as_json))


def encode(  # noqa: PLR0913 - one parameter per option of the command line
    mesh: MeshArgument,
    *,
    output: Annotated[Path, typer.Option("--output", "-o", help="Where to put the .qpz file; -: standard output.")],
    max_error: Annotated[
        float, typer.Option(help="How far the decoded surface may lie from the scan at most, in mesh units.")
    ],
    keep_connectivity: Annotated[
        bool, typer.Option("--keep-connectivity", help="Store the triangles as well: every vertex comes back.")
    ] = False,
    model: ModelOption = None,
    seed: SeedOption = 0,
    label: LabelOption = None,
    report: ReportOption = None,
    preview: PreviewOption = None,
    html: HtmlOption = None,
    pdf: PdfOption = None,
    again: AgainOption = False,
    timeout: TimeoutOption = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
    quiet: QuietOption = False,
) -> None:
    """Compress the surface of a scan into a .qpz file, within a proven error."""

    def task() -> Task:
        if not is_stream(output) and output.suffix.lower() != _SUFFIX:
            raise UsageError(f"{output} does not end in {_SUFFIX}, which is what encoding writes")
        options = {"max_error": max_error, "keep_connectivity": keep_connectivity}
        rest = {"task": "encode", "encode": options, "seed": seed, "label": label}
        rest["output"] = {"preview": preview is not None, "html_report": (html or pdf) is not None}
        return Task(
            mesh,
            output,
            method=_method(model),
            rest=rest,
            report=report,
            preview=preview,
            html=html,
            pdf=pdf,
            timeout_s=timeout,
            again=again,
        )

    run(task, Connection(url, api_key, quiet, as_json))


def decode(  # noqa: PLR0913 - one parameter per option of the command line
    mesh: EncodedArgument,
    *,
    output: OutputOption,
    model: ModelOption = None,
    label: LabelOption = None,
    format_: FormatOption = None,
    report: ReportOption = None,
    preview: PreviewOption = None,
    html: HtmlOption = None,
    pdf: PdfOption = None,
    again: AgainOption = False,
    timeout: TimeoutOption = None,
    url: UrlOption = DEFAULT_URL,
    api_key: KeyOption = None,
    as_json: JsonOption = False,
    quiet: QuietOption = False,
) -> None:
    """Bring back the surface of a .qpz file, with the model that it was encoded with."""

    def task() -> Task:
        rest = {"task": "decode", "label": label, "output": _output(output, format_, preview, html or pdf)}
        return Task(
            mesh,
            output,
            method=_method(model),
            rest=rest,
            report=report,
            preview=preview,
            html=html,
            pdf=pdf,
            timeout_s=timeout,
            again=again,
        )

    run(task, Connection(url, api_key, quiet, as_json))


def _method(model: str | None) -> MethodChoice:
    """Return the method that a model means: `smooth` is geometry alone."""
    return MethodChoice("smooth") if model == "smooth" else MethodChoice(model=model)


def _output(output: Path, format_: Any, preview: Path | None, page: Path | None) -> dict[str, Any]:
    return {
        "format": format_ or format_of(output),
        "preview": preview is not None,
        "html_report": page is not None,
    }
