"""Pages of the tasks besides filling holes: their first lines, and their figures in order.

Tested in `tests/quadpatch/html_report/test_task_words.py`.
"""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from quadpatch.html_report.in_short import QUESTIONS, Answer, counted
from quadpatch.html_report.words import figure

Figure = str | int | float | None

TITLES: Mapping[str, str] = MappingProxyType(
    {
        "fill": "Repair report",
        "restore": "Restoration report",
        "denoise": "Denoising report",
        "encode": "Compression report",
        "decode": "Decompression report",
    }
)

# What the table shows, by the place in the report; a place that a report does not have is left out.
FIGURES: Mapping[str, Mapping[str, str]] = MappingProxyType(
    {
        "restore": {
            "vertices.missing": "Vertices without a position",
            "vertices.restored": "Vertices that got one",
            "vertices.left": "Vertices that stay without one",
            "placement": "How they were placed",
            "expected_error.median": "Expected error: half of them are closer",
            "expected_error.percentile_95": "Expected error: 95 of 100 are closer",
            "expected_error.rms": "Expected error, root mean square",
            "hidden_vertices.count": "Measured vertices that were hidden and restored to find that out",
            "hidden_vertices.rms_error": "Root mean square error of each way to place them",
            "patches.count": "Patches",
        },
        "denoise": {
            "noise": "Noise, standard deviation",
            "noise_estimated": "Noise was estimated",
            "moved_vertices": "Vertices that were moved",
            "shift_mean": "Mean shift of these",
            "shift_95": "95 of 100 of these moved no farther than",
            "shift_max": "Largest shift",
            "max_shift": "Largest shift that was allowed",
            "vertices_at_bound": "Vertices that this held back",
            "turned_triangles": "Triangles whose normals turned by over 90 degrees",
            "folds.before": "Folds before the check",
            "folds.undone": "Folds that the check took back",
            "shares": "Filters that were mixed",
            "patches.count": "Patches",
        },
        "encode": {
            "bytes": "Size of the file, in bytes",
            "ratio": "Times smaller than 32-bit positions and triangles",
            "bytes_per_vertex": "Bytes for each vertex of the scan",
            "max_error.promised": "Largest error that was promised",
            "max_error.true_to_decoded": "Largest distance from the scan to the decoded surface",
            "max_error.decoded_to_true": "Largest distance from the decoded surface to the scan",
            "rms_error.true_to_decoded": "Root mean square distance from the scan",
            "rms_error.decoded_to_true": "Root mean square distance from the decoded surface",
            "psnr.true_to_decoded": "Peak signal-to-noise ratio from the scan, in dB",
            "psnr.decoded_to_true": "Peak signal-to-noise ratio from the decoded surface, in dB",
            "decoded.vertices": "Vertices of the decoded mesh",
            "decoded.triangles": "Triangles of the decoded mesh",
            "patches.count": "Patches",
            "corrections": "Grid vertices with a correction",
            "triangles_as_they_are": "Triangles stored without patches",
            "draco_estimate": "Bytes that edge collapse and Draco would take, estimated",
        },
        "decode": {
            "source.bytes": "Size of the file, in bytes",
            "max_error": "Largest distance to the scan, as the file promises",
            "decoded.vertices": "Vertices of the decoded mesh",
            "decoded.triangles": "Triangles of the decoded mesh",
            "keeps_connectivity": "Vertices and triangles are those of the scan",
            "patches.count": "Patches",
        },
    }
)


def figures(report: Mapping[str, Any]) -> list[tuple[str, Figure]]:
    """Return what the table of figures shows: titles with numbers, None or text."""
    rows: list[tuple[str, Figure]] = []
    for path, title in FIGURES[report["task"]].items():
        found, value = value_at(report, path)
        if not found:
            continue
        if isinstance(value, Mapping):
            rows += [(f"{title}: {name.replace('_', ' ')}", number) for name, number in value.items()]
        else:
            rows.append((title, _yes_or_no(value)))
    return rows


def value_at(report: Mapping[str, Any], path: str) -> tuple[bool, Any]:
    """Return whether a report has something at a dotted place, and what."""
    value: Any = report
    for step in path.split("."):
        if not isinstance(value, Mapping) or step not in value:
            return False, None
        value = value[step]
    return True, value


def task_in_short(report: Mapping[str, Any]) -> list[tuple[str, list[Answer]]]:
    """Answer the four questions from the report of a task other than `fill`."""
    answers = _ANSWERS[report["task"]](report)
    return [(question, [Answer(text) for text in texts]) for question, texts in zip(QUESTIONS, answers, strict=True)]


_Four = tuple[list[str], list[str], list[str], list[str]]


def _restore(report: Mapping[str, Any]) -> _Four:
    counts, error, unit = report["vertices"], report["expected_error"], report["length_unit"]
    measured = report["source"]["vertices"] - counts["missing"]
    sure = "There is no measure of it: too few vertices are measured."
    if error["median"] is not None:
        sure = (
            f"Half of them are expected to lie within {figure(error['median'])} {unit} of their true place, 95 of 100 "
            f"within {figure(error['percentile_95'])} {unit}."
        )
    todo = ["Look at the tinted places in the picture: there the positions are guesses."] * bool(counts["restored"])
    if counts["left"]:
        left = counted(counts["left"], "vertex has", "vertices have")
        todo.append(f"{left} no position still: no measured vertex is connected to them.")
    return (
        [f"{counted(measured, 'vertex', 'vertices')}. They stay where they were."],
        [f"The positions of {counts['restored']:,} of {counts['missing']:,} missing vertices."],
        [sure] if counts["restored"] else [],
        [*todo, *_warned(report)],
    )


def _denoise(report: Mapping[str, Any]) -> _Four:
    unit, moved = report["length_unit"], report["moved_vertices"]
    estimated = "was estimated at" if report["noise_estimated"] else "was given as"
    todo = ["Compare with the scan where edges and small detail matter, and keep the scan: shifts can't be undone."]
    if report["vertices_at_bound"]:
        held = counted(report["vertices_at_bound"], "vertex was", "vertices were")
        todo.append(f"{held} held back by the largest shift that was allowed: allow more if noise is left there.")
    if report["folds"]["left"]:
        todo.append(f"Look at {counted(len(report['folds']['left']), 'triangle')} that fold over: the JSON names them.")
    return (
        [f"{counted(report['source']['vertices'], 'vertex', 'vertices')} of the scan."],
        [f"No vertex and no triangle was added. {moved:,} measured vertices were moved: they are corrected values."],
        [
            f"No vertex moved farther than {figure(report['shift_max'])} {unit}, 95 of 100 no farther than "
            f"{figure(report['shift_95'])} {unit}. The noise {estimated} {figure(report['noise'])} {unit}."
        ],
        [*(todo if moved else ["Nothing: no vertex was moved."]), *_warned(report)],
    )


def _encode(report: Mapping[str, Any]) -> _Four:
    unit, error = report["length_unit"], report["max_error"]
    farthest = max(value for value in (error["true_to_decoded"], error["decoded_to_true"]) if value is not None)
    size = f"{report['bytes']:,} bytes, {figure(report['ratio'])} times smaller"
    return (
        [f"The scan: {counted(report['source']['triangles'], 'triangle')}. The file keeps its shape in {size}."],
        ["No surface was added. The decoded surface has other triangles unless connectivity was kept."],
        [
            f"The file was decoded and compared: no point lies farther than {figure(farthest)} {unit} from the other "
            f"surface; {figure(error['promised'])} {unit} was promised."
        ],
        [
            "Keep the scan where its vertices are evidence: this file holds the shape alone.",
            *_warned(report),
        ],
    )


def _decode(report: Mapping[str, Any]) -> _Four:
    unit = report["length_unit"]
    kept = "are those of the scan" if report["keeps_connectivity"] else "are not those of the scan"
    return (
        [f"Nothing anew: the file was made from a scan. Vertices and triangles {kept}."],
        ["Nothing: the surface is that of the encoded scan, within the error below."],
        [f"The surface lies within {figure(report['max_error'])} {unit} of the scan, as the file promises."],
        ["Ask for the scan where its measured vertices are needed.", *_warned(report)],
    )


_ANSWERS: Mapping[str, Callable[[Mapping[str, Any]], _Four]] = MappingProxyType(
    {"restore": _restore, "denoise": _denoise, "encode": _encode, "decode": _decode}
)


def _warned(report: Mapping[str, Any]) -> list[str]:
    n = len(report["warnings"])
    return [f"Read the {counted(n, 'warning')} below."] if n else []


def _yes_or_no(value: Any) -> Figure:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return str(value).replace("_", " ") if isinstance(value, str) else value
