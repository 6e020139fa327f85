"""Options of `batch` and `watch`, the commands that work on a folder."""

from pathlib import Path
from typing import Annotated

import typer

from quadpatch_client.conditions import QUANTITIES, Condition, read_condition
from quadpatch_client.file_repair import JobOptions
from quadpatch_client.options import HoleChoice, MethodChoice

FolderArgument = Annotated[
    Path, typer.Argument(metavar="DIR", help="Folder with mesh files.", exists=True, file_okay=False, readable=True)
]
WhereOption = Annotated[
    list[str] | None,
    typer.Option(
        "--where",
        metavar="QUANTITY<=>VALUE",
        help="Skip files that are not so: holes>0, triangles<=5000000, name=*.stl. Repeat for more; all have to hold. "
        f"Quantities: {', '.join(QUANTITIES)}.",
        rich_help_panel="Which files",
    ),
]
ParallelOption = Annotated[int, typer.Option("--parallel", min=1, max=64, help="Files at a time.")]
FolderHtmlOption = Annotated[bool, typer.Option("--html", help="Fetch the report as an HTML page, too.")]
FolderPreviewOption = Annotated[bool, typer.Option("--preview", help="Fetch a picture before and after, too.")]


def conditions_of(where: list[str] | None) -> tuple[Condition, ...]:
    """Read the conditions that were typed."""
    return tuple(read_condition(text) for text in where or ())


def job_options(
    holes: HoleChoice, method: MethodChoice, rest: dict[str, object], where: list[str] | None, *outputs: str
) -> JobOptions:
    """Return what is asked for every file, and check it before the first one is sent.

    Parameters
    ----------
    holes : HoleChoice
    method : MethodChoice
    rest : dict
        Further fields of the job spec.
    where : list of str, optional
        Conditions as they were typed.
    *outputs : str
        Of `preview` and `html_report`, which are made.

    Raises
    ------
    UsageError
    """
    from quadpatch_client.spec import make_spec  # noqa: PLC0415  loads the wire schema, which --help does without

    rest = {**rest, "output": {"format": rest.get("format"), **dict.fromkeys(outputs, True)}}
    del rest["format"]
    make_spec("0" * 64, holes, method, **rest)
    return JobOptions(holes, method, rest, conditions_of(where))
