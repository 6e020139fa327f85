"""Warnings: a sentence for people, with a stable code and the values in it for programs.

A warning is a text, so what only passes it on needs to know of nothing else. Where JSON is made of it,
`described` writes code and values beside the sentences.
"""

from collections.abc import Iterable, Mapping
from math import isfinite
from numbers import Integral
from types import MappingProxyType
from typing import Any

from quadpatch_rules.text import printable

Value = str | int | float

# What has no code of its own: sentences by earlier versions, and of what is not in the table.
OTHER = "other"

WARNINGS: Mapping[str, str] = MappingProxyType(
    {
        # What a file holds.
        "surface_doubled": "{copies:,} of {faces:,} faces are exact copies of others: the surface is doubled; holes "
        "were looked for on one copy, and the file keeps all",
        "copies_ignored": "{copies:,} faces are exact copies of others: ignored, and kept in the file",
        "fins_ignored": "{fins:,} faces hang on edges that have two faces without them: ignored as fins, and kept in "
        "the file",
        "faces_turned_over": "{turned:,} faces are turned over against their neighbours: taken for facing the other "
        "way, and kept in the file as they are",
        # What a written file lacks, or says otherwise.
        "unit_implied": "the scan states no length unit, and {suffix} always means {unit}: the numbers are unchanged; "
        "length_unit says what they are in",
        "precision_short": "{format} holds 32-bit numbers, which round the coordinates of this mesh to steps of "
        "{step:.3g}; its mean edge length is {edge:.3g}",
        "triangles_collapse": "{format} holds 32-bit numbers, which round the coordinates of this mesh to steps of "
        "{step:.3g}; its mean edge length is {edge:.3g}, and {collapsed:,} triangles collapse",
        "coordinates_rounded": "coordinates are rounded to the numbers of the file, by up to {rounding:.3g}",
        "attributes_left_out": "colours, normals and the like are left out of the mesh, which holds the shape alone: "
        "{reason}",
        "file_written_anew": "the mesh is written anew, without what its file held besides it: {reason}",
        "normals_computed_anew": "the stored normals of {vertices:,} vertices that moved are computed anew",
        "numbers_left_out": "{format} has no place for numbers of vertices: {names} left out, which PLY keeps",
        "shape_alone": "{names} are left out: an encoded mesh holds the shape alone",
        # Colours and textures.
        "colours_not_continued": "colours were not carried on over the fills: {reason}",
        "textures_not_written": "{suffix} is written without the texture images of the scan",
        "textures_not_continued": "the texture images of the scan are not carried on: {reason}",
        "texture_image_not_continued": "the texture image {image!r} is not carried on ({image_code}): {reason}",
        # What a model had too little for.
        "too_little_surface": "too little undamaged surface to learn from; the holes were filled by geometry alone",
        "no_patches": "{reason}; the holes were filled by geometry alone",
        "too_little_surface_for_paper": "too little undamaged surface to learn from; the holes were closed, nothing "
        "more",
        "no_patches_for_paper": "{reason}; the holes were closed, nothing more",
        "too_little_surface_to_restore": "too little surface to learn from; the vertices were restored by geometry "
        "alone",
        "no_patches_to_restore": "{reason}; the vertices were restored by geometry alone",
        "no_patches_to_denoise": "{reason}; no patches took part",
        # What a task left.
        "expected_error_unknown": "too few vertices are measured to hide some of them: the expected error is not known",
        "vertices_unreachable": "{left:,} missing vertices are connected to no measured one: they are left as they "
        "were",
        "no_noise": "the surface shows no noise: nothing was moved",
        "folds_left": "{folds:,} pairs of triangles fold over each other that did not before",
        "beyond_max_shift": "the numbers of the file put {vertices:,} vertices beyond max_shift, by up to {excess:.3g}",
        "vertices_unseen": "no patch sees {vertices:,} vertices: they keep their place",
        "larger_than_draco": "edge collapse and Draco would take about {draco:,.0f} bytes in place of {bytes:,} at the "
        "same RMS error, without a promised largest error",
        "hole_refused": "1 hole was refused and left open; the report says why",
        "holes_refused": "{refused:,} holes were refused and left open; the report says why",
        "limits_missed": "{sentence}",
        # Pictures and pages.
        "no_preview": "there is no picture: {reason}",
        "no_close_ups": "there are no close-ups: {reason}",
        "no_close_up": "there is no close-up of hole {hole}: {reason}",
        "close_ups_limited": "close-ups show {shown} of {holes} holes, the widest",
        "no_html_report": "there is no HTML report: {reason}",
        "no_overview": "the HTML report has no picture of the whole: {reason}",
        "no_pdf_report": "there is no PDF: {reason}",
        # Models and trainings.
        "deprecated_model": "the model {model} is deprecated",
        "deprecated_model_for": "the model {model} is deprecated: {reason}",
        "mesh_left_out": "mesh {mesh} is left out ({mesh_code}): {reason}",
        "mesh_without_room": "mesh {mesh} has no room for holes to judge by",
        "mesh_not_judged": "mesh {mesh} can't be judged ({mesh_code}): {reason}",
    }
)


class CodedWarning(str):
    """A sentence that knows its code, and the values in it by name."""

    __slots__ = ("code", "values")

    code: str
    values: Mapping[str, Value]

    def __new__(cls, sentence: str, code: str = OTHER, values: Mapping[str, Value] | None = None) -> "CodedWarning":
        """Make one of a sentence; `warning` makes those of the table."""
        made = super().__new__(cls, sentence)
        made.code, made.values = code, dict(values or {})
        return made


def warning(code: str, **values: Value) -> CodedWarning:
    """Make the warning of a code.

    Parameters
    ----------
    code : str
        Of `WARNINGS`.
    **values : str, int or float
        What stands in its sentence, by name; lengths are in mesh units.
    """
    plain = {name: _plain(value) for name, value in values.items()}
    return CodedWarning(WARNINGS[code].format(**plain), code, plain)


def described(warnings: Iterable[str]) -> dict[str, list[Any]]:
    """Return the fields that a report has of its warnings: `warnings`, and `warning_details`."""
    report: dict[str, list[Any]] = {"warnings": [], "warning_details": []}
    for sentence in warnings:
        add_warning(report, sentence)
    return report


def add_warning(report: dict[str, Any], sentence: str) -> None:
    """Add a warning to a report; what had no details before gets some without a code."""
    report["warnings"].append(sentence)
    details = report.setdefault("warning_details", [])
    details += [_detail(warning) for warning in report["warnings"][len(details) :]]
    report["warnings"][-1] = str(sentence)


def _detail(sentence: str) -> dict[str, Any]:
    known = sentence if isinstance(sentence, CodedWarning) else CodedWarning(sentence)
    # JSON knows no infinity.
    values = {name: value if _is_json(value) else str(value) for name, value in known.values.items()}
    return {"code": known.code, "message": str(sentence), "values": values}


def _plain(value: Value) -> Value:
    """Turn numbers of other libraries into those of Python, and text into what can be printed."""
    if isinstance(value, str):
        return printable(value)
    return int(value) if isinstance(value, Integral) else float(value)


def _is_json(value: Value) -> bool:
    return not isinstance(value, float) or isfinite(value)
