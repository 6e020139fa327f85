"""The report of a repair, ready for JSON. Lengths are in the file's unit, which `length_unit` names.

A number that is not finite is null.
"""

import json
import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict
from functools import lru_cache
from typing import Any

import numpy as np

from quadpatch.filling.bridges import Bridge
from quadpatch.filling.fairing import Energy
from quadpatch.formats.scan import Scan
from quadpatch.mesh.holes import Hole
from quadpatch.mesh.measures import bounding_box, mean_edge_length
from quadpatch.mesh.weld import Weld, WeldCounts
from quadpatch.options import RepairOptions
from quadpatch.recipes.result import Completion, HoleResult, Repair
from quadpatch.stages import Stages
from quadpatch.types import TriangleMesh
from quadpatch_rules.coded_warnings import described, warning
from quadpatch_rules.text import printable

VERDICTS = ("filled", "filled_smooth", "skipped", "refused")
UNKNOWN_UNIT = "mesh units"

# With more copies than this share of the faces that they copy, a surface is doubled as a whole.
DOUBLED_SHARE = 0.5


def describe_mesh(scan: Scan, mesh: TriangleMesh) -> dict[str, Any]:
    """Facts of a mesh: counts as in the file, box and mean edge length in its unit."""
    low, high = bounding_box(mesh)
    return {
        "format": scan.format,
        "vertices": len(scan.vertices),
        "triangles": len(scan.triangles),
        "bounding_box": {"min": low.tolist(), "max": high.tolist()},
        "mean_edge_length": mean_edge_length(mesh),
    }


def describe_hole(hole: Hole) -> dict[str, Any]:
    """Measures and place of a hole, JSON-ready."""
    return {
        "id": hole.id,
        "edges": hole.n_edges,
        "perimeter": hole.perimeter,
        "diameter": hole.diameter,
        "area": hole.area,
        "planarity": hole.planarity,
        "is_manifold": hole.is_manifold,
        "is_border": hole.is_border,
        "kind": hole.kind,
        "centre": list(hole.centre),
        "normal": list(hole.normal),
        "bounding_box": {"min": list(hole.low), "max": list(hole.high)},
    }


def describe_redundancy(counts: WeldCounts) -> list[str]:
    """Say what the file holds more than once, or the wrong way round, in sentences for people."""
    n, copies = counts.triangles, counts.duplicate_triangles
    warnings = list[str]()
    if copies > DOUBLED_SHARE * (n - copies):
        warnings.append(warning("surface_doubled", copies=copies, faces=n))
    elif copies:
        warnings.append(warning("copies_ignored", copies=copies))
    if counts.fin_triangles:
        warnings.append(warning("fins_ignored", fins=counts.fin_triangles))
    if counts.turned_triangles:
        warnings.append(warning("faces_turned_over", turned=counts.turned_triangles))
    return warnings


def number_holes(report: dict[str, Any], first: int | None) -> None:
    """Add to each hole of a report the number that it has in the file: `first` plus its id, null where it has none."""
    for row in report["holes"]:
        row["hole_id"] = None if first is None or not row["new_triangles"] else first + row["id"]


def build_report(
    scan: Scan, welded: Weld, repair: Repair, options: RepairOptions, model: dict[str, Any], stages: Stages
) -> dict[str, Any]:
    """Put everything that a user may want to know about a repair into one JSON-ready object."""
    completion, verdicts = repair.completion, Counter(result.verdict for result in repair.results)
    report: dict[str, Any] = {
        "schema": 1,
        "task": "fill",
        "source": describe_mesh(scan, welded.mesh),
        "welded": asdict(welded.counts),
        "length_unit": scan.unit or UNKNOWN_UNIT,
        "model": {**model, **_competition(completion), **_fitting(completion)},
        "options": plain_options(options),
        "counts": {
            "found": len(repair.results),
            **{verdict: verdicts[verdict] for verdict in VERDICTS},
        },
        "patches": None
        if completion is None
        else {
            "length": completion.scale.length,
            "resolution": completion.scale.resolution,
            "overlap": completion.scale.overlap,
            "count": completion.n_patches,
            "believed_share": completion.blend_factor,
        },
        "calibration": _calibration(repair),
        "stages": describe_stages(stages),
        **described(repair.warnings),
    }
    return {**json_ready(report), "holes": [_hole(result) for result in repair.results]}


def _competition(completion: Completion | None) -> dict[str, Any]:
    """Say which models competed, and what part the winners have; nothing where none did."""
    if completion is None or not completion.trials:
        return {}
    trials = [
        {
            "models": trial.shares,
            "believed_share": trial.blend_factor,
            "error": trial.error,
            "calibration_holes": trial.n_holes,
        }
        for trial in completion.trials
    ]
    return {"shares": completion.shares, "trials": trials}


def _fitting(completion: Completion | None) -> dict[str, Any]:
    """Say how a network was fitted to the mesh; nothing where none was."""
    return {} if completion is None or completion.fitting is None else {"fitting": asdict(completion.fitting)}


def describe_task(
    task: str, scan: Scan, mesh: TriangleMesh, model: dict[str, Any], options: Any, stages: Stages
) -> dict[str, Any]:
    """Return what the reports of all tasks begin with: the scan and its surface, the model, a dataclass of options."""
    return {
        "schema": 1,
        "task": task,
        "source": describe_mesh(scan, mesh),
        "length_unit": scan.unit or UNKNOWN_UNIT,
        "model": model,
        "options": plain_options(options),
        "stages": describe_stages(stages),
    }


def plain_options(options: Any) -> dict[str, Any]:
    """Turn a dataclass of options into what its JSON reads as: tuples become lists."""
    plain: dict[str, Any] = json.loads(json.dumps(asdict(options)))
    return plain


def describe_stages(stages: Stages) -> list[dict[str, Any]]:
    """Return the seconds of every stage, in order, and the most memory that the process had had by its end."""
    return [
        {"name": name, "seconds": round(seconds, 4), "peak_memory_mib": stages.peak_memory_mib[name]}
        for name, seconds in stages.seconds.items()
    ]


def _calibration(repair: Repair) -> dict[str, Any] | None:
    """Say how many calibration holes there were, and how long calibration took, in this repair or an earlier one."""
    record = repair.calibration
    if record is None:
        return None
    return {"holes": record.n_holes, "reused": repair.is_calibration_reused, "seconds": round(record.seconds, 4)}


def _hole(result: HoleResult) -> dict[str, Any]:
    row = {
        **describe_hole(result.hole),
        "verdict": result.verdict,
        "code": result.code or None,
        "reason": result.reason or None,
        "confidence": result.confidence,
        "expected_error": result.expected_error,
        "fill": result.fill or None,
        "energies": [{**_weights(energy), "share": share} for energy, share in result.energies] or None,
        "new_vertices": result.n_new_vertices,
        "new_triangles": result.n_new_triangles,
        "measures": result.measures,
        "bridge": None if result.bridge is None else _bridge(result.bridge),
    }
    # Many times faster than to turn millions of values one by one.
    return row if _is_plain(result) else json_ready(row)


def _bridge(bridge: Bridge) -> dict[str, Any]:
    return {"holes": [hole.id for hole in bridge.holes], "shape": bridge.shape, "gap": bridge.gap}


@lru_cache
def _weights(energy: Energy) -> dict[str, float]:
    return asdict(energy)


def _is_plain(result: HoleResult) -> bool:
    """Whether the row of a hole is JSON-ready as it is: its numbers are finite, and its words printable."""
    hole = result.hole
    numbers = (hole.perimeter, hole.diameter, hole.area, hole.planarity, *hole.centre, *hole.normal)
    guesses = (result.confidence or 0.0, result.expected_error or 0.0, *result.measures.values())
    is_finite = all(map(math.isfinite, (*numbers, *hole.low, *hole.high, *guesses)))
    return is_finite and printable(result.reason) == result.reason


_PLAIN = (int, bool, type(None))


def json_ready(value: Any) -> Any:
    """Turn nested values into plain ones.

    Parameters
    ----------
    value : Any
        Mappings, sequences, arrays, numpy scalars and plain values.

    Returns
    -------
    Any
        Dicts, lists, printable strings, booleans, integers, finite floats and None. JSON knows no NaN and no
        infinity: both become None.
    """
    # Reports of scans with many holes hold millions of values: the usual kinds come first, by their exact type.
    kind = type(value)
    if kind in _PLAIN:
        return value
    if kind is dict or isinstance(value, Mapping):
        return {printable(str(name)): json_ready(item) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [json_ready(item) for item in value]
    if isinstance(value, np.ndarray | np.generic):
        return json_ready(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return printable(value) if isinstance(value, str) else value
