"""`fill` repairs a file."""

import logging
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer

from quadpatch.cli.calibration_file import read_calibrations, write_calibrations
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
    WeldTolerance,
    read_tolerance,
)
from quadpatch.cli.messages import clear_errors, progress_bars, say
from quadpatch.cli.reports import closing_words, n_holes, write_report
from quadpatch.cli.scipy_start import prepare_libraries
from quadpatch.errors import OptionError
from quadpatch.formats.output_files import check_folder, check_outputs, is_stream
from quadpatch.options import DictionaryOptions, HoleOptions, HoleRule, NetworkOptions, PatchOptions, RepairOptions
from quadpatch_rules.competition import outcome
from quadpatch_rules.hole_selection import Cap
from quadpatch_rules.option_words import CarriedAttribute, Colours, Effort, Recipe, Tint
from quadpatch_rules.rule_text import RuleTextError, read_bridge, read_rule

if TYPE_CHECKING:
    from quadpatch.html_report.provenance import Start
    from quadpatch.repair import RepairedFile

FITTING = NetworkOptions()


def fill(  # noqa: PLR0913, PLR0917  one argument per flag
    source: Source,
    output: Output,
    model: Annotated[
        str | None,
        typer.Option(
            help="auto (what is best on this very mesh: see --effort), self (learn a dictionary from it), "
            "self-network (fit a network to it: a minute), smooth (geometry only), a shipped model, or a model file.",
            show_default="auto; self with the recipe paper",
        ),
    ] = None,
    effort: Annotated[
        Effort,
        typer.Option(
            help="How much auto tries: fast (geometry only), standard (also a dictionary of this mesh and the shipped "
            "network: seconds), best (also a network fitted to this mesh: a minute)."
        ),
    ] = "standard",
    recipe: Annotated[
        Recipe, typer.Option(help="How the model is put to use: our way, or exactly the paper's.")
    ] = "default",
    report: Report = None,
    preview: Preview = None,
    closeups: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Draw every chosen hole before and after, as hole_<id>.png in this folder."),
    ] = None,
    html: Html = None,
    tint: Annotated[
        Tint,
        typer.Option(
            help="What the colours of invented surface say in pictures: that it is invented, or its confidence."
        ),
    ] = "invented",
    overwrite: Overwrite = False,
    calibration: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Keep here what calibration finds out, for the next repair of this scan with the same options, such "
            "as with another model; read if it is there.",
        ),
    ] = None,
    max_diameter: Annotated[float | None, typer.Option(help="Leave wider holes open (mesh units).")] = None,
    max_perimeter: Annotated[float | None, typer.Option(help="Leave longer rims open (mesh units).")] = None,
    all_but_largest: Annotated[bool, typer.Option(help="Leave the widest loop open.")] = False,
    hole: Annotated[list[int] | None, typer.Option(help="Fill just this hole; repeat for more.")] = None,
    include_borders: Annotated[
        bool, typer.Option("--include-borders", help="Treat outer borders of pieces like holes.")
    ] = False,
    cap: Annotated[Cap | None, typer.Option(help="Close open ends, as of tubes, by a plane patch.")] = None,
    rule: Annotated[
        list[str] | None,
        typer.Option(
            metavar="[CONDITION,...:]ACTION",
            help="What to do with some holes: max_diameter=5:smooth, kind=open_end:flat, id=3,id=4:skip. "
            "Repeat for more; the first that fits counts.",
        ),
    ] = None,
    bridge: Annotated[
        list[str] | None,
        typer.Option(
            metavar="ID:ID",
            help="Join these two loops by a strip of surface, as across a cut: 3:17. Repeat for more; see `holes`.",
        ),
    ] = None,
    patch_length: PatchLength = None,
    resolution: Resolution = None,
    overlap: Overlap = None,
    preset: PatchPreset = None,
    atoms: Annotated[int | None, typer.Option(help="Atoms to learn (recipe paper, model self).")] = None,
    nonzero: Annotated[
        int | None, typer.Option(help="Atoms that one patch may use (recipe paper, model self).")
    ] = None,
    fit_steps: Annotated[
        int, typer.Option(help="Fit at most so many steps (self-network, effort best).")
    ] = FITTING.steps,
    fit_seconds: Annotated[
        float | None, typer.Option(help="Fit at most so long (self-network, effort best).", show_default="no limit")
    ] = FITTING.seconds,
    weld_tolerance: WeldTolerance = "auto",
    colours: Annotated[
        Colours,
        typer.Option(
            help="Colours of new vertices and texels: the texture around a hole carried on where calibration finds "
            "that better, or just spread from its rim."
        ),
    ] = "auto",
    length_unit: Unit = None,
    attribute: Annotated[
        list[str] | None,
        typer.Option(
            metavar="colours|normals|texture_coordinates",
            help="Carry this besides the shape into another format than that of the scan; repeat for more.",
            show_default="all that both formats know",
        ),
    ] = None,
    learn_from: Annotated[
        Path | None,
        typer.Option(
            metavar="MESH",
            help="Learn the dictionary (model self) from this mesh, in the same unit: one of the same kind that is "
            "whole, or less worn.",
        ),
    ] = None,
    seed: Seed = 0,
    quiet: Quiet = False,
) -> None:
    """Repair a mesh file."""
    with clear_errors(), progress_bars(quiet) as progress:
        options = RepairOptions(
            HoleOptions(
                max_diameter,
                max_perimeter,
                all_but_largest,
                tuple(hole) if hole else None,
                include_borders,
                cap,
                tuple(_rule(text) for text in rule or ()),
                tuple(_bridge(text) for text in bridge or ()),
            ),
            PatchOptions(patch_length, resolution, overlap, preset),
            seed,
            recipe,
            DictionaryOptions(atoms, nonzero),
            NetworkOptions(fit_steps, fit_seconds),
            read_tolerance(weld_tolerance),
            effort,
            colours,
            length_unit,
            cast(tuple[CarriedAttribute, ...], tuple(attribute)) if attribute else None,  # options look at them
        )
        if calibration and recipe == "paper":
            raise OptionError("--calibration goes with the recipe default: the paper calibrates nothing")
        others = [path for path in (report, preview, calibration, html) if path]
        check_outputs(source, output, others, may_overwrite=overwrite)
        if closeups:
            check_folder(closeups, [source, output, *others])
        if learn_from:
            check_outputs(learn_from, output, others, may_overwrite=False)
        prepare_libraries()
        from quadpatch.processes import ProcessPool, n_processes_for, usable_threads  # noqa: PLC0415  see below
        from quadpatch.repair import repair_and_keep  # noqa: PLC0415  numerical libraries, once there is work to do

        kept, start = read_calibrations(calibration), _note_start(source) if html else None
        with ProcessPool(n_processes_for(source, usable_threads())) as pool:
            repaired = repair_and_keep(
                source, output, model, options, progress, kept=kept, pool=pool, learn_from=learn_from
            )
        logging.getLogger("quadpatch").addHandler(logging.NullHandler())  # what people read is in the warnings
        if report and (preview or closeups or html) and not is_stream(report):  # drawing may take the process down
            write_report(repaired.report, report)
        _draw(repaired, preview, closeups, tint)
        if html and start:
            _write_page(repaired, html, start, output, preview, tint)
        write_report(repaired.report, report)
        write_calibrations(calibration, kept)
    if not quiet:
        say(summary(repaired.report))


def _rule(text: str) -> HoleRule:
    """Read one `--rule`; what is no rule raises OptionError."""
    try:
        return HoleRule.from_dict(read_rule(text))
    except RuleTextError as error:
        raise OptionError(str(error)) from error


def _bridge(text: str) -> tuple[int, int]:
    """Read one `--bridge`; what is no bridge raises OptionError."""
    try:
        return read_bridge(text)
    except RuleTextError as error:
        raise OptionError(str(error)) from error


def summary(report: dict[str, Any]) -> str:
    """One paragraph for people: what was found, filled and left open, and why."""
    counts = report["counts"]
    open_holes = counts["skipped"] + counts["refused"]
    base = report["model"].get("fitted_from")
    model = f"{base}, fitted to this mesh" if base else "the model"
    text = f"{n_holes(counts['found'])}: {counts['filled']} filled by {model}, {counts['filled_smooth']} by geometry"
    text += _reasons(report, "filled_smooth") + f", {open_holes} left open" + _reasons(report, "skipped", "refused")
    if report["colours"]:
        text += f"; colours: {report['colours']['method']}"
    competition = outcome(report["model"])
    return " ".join(filter(None, [f"{text}.", competition, closing_words(report)]))


def _reasons(report: dict[str, Any], *verdicts: str) -> str:
    """Count the reasons behind some verdicts, in brackets; empty where there are none."""
    counts = Counter(row["reason"] for row in report["holes"] if row["verdict"] in verdicts)
    return " (" + "; ".join(f"{count} × {reason}" for reason, count in counts.items()) + ")" if counts else ""


def _draw(repaired: "RepairedFile", preview: Path | None, closeups: Path | None, tint: Tint) -> None:
    """Draw what was asked for; what fails is a warning in the report."""
    if not (preview or closeups):
        return
    from quadpatch.preview.drawing import add_close_ups, add_picture  # noqa: PLC0415  see fill

    if preview:
        add_picture(repaired, preview, tint)
    if closeups:
        add_close_ups(repaired, closeups, tint)


def _note_start(source: Path) -> "Start":
    """Note which bytes are to be repaired, and when: the output may overwrite them."""
    from quadpatch.html_report.provenance import note_start  # noqa: PLC0415  see fill

    return note_start(source)


def _write_page(
    repaired: "RepairedFile", page: Path, start: "Start", output: Path, preview: Path | None, tint: Tint
) -> None:
    """Write the HTML report; what fails is a warning in the report."""
    from quadpatch.html_report.writing import PageOrder, add_html_report  # noqa: PLC0415  see fill

    add_html_report(repaired, PageOrder(start, output, overview=preview, tint=tint), page)
