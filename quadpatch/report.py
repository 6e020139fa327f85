"""The report of a repair, ready for JSON. Lengths are in the file's unit, which `length_unit` names."""

from dataclasses import asdict
from typing import Any

from quadpatch.formats.scan import Scan
from quadpatch.judge import HoleResult
from quadpatch.mesh.holes import Hole
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.options import RepairOptions
from quadpatch.pipeline import Repair
from quadpatch.stages import Stages
from quadpatch.types import TriangleMesh

VERDICTS = ("filled", "filled_smooth", "skipped", "refused")
UNKNOWN_UNIT = "mesh units"


def describe_mesh(scan: Scan, mesh: TriangleMesh) -> dict[str, Any]:
    """Facts of a mesh: counts as in the file, box and mean edge length in its unit."""
    used = mesh.vertices[mesh.triangles].reshape(-1, 3)
    return {
        "format": scan.format,
        "vertices": len(scan.vertices),
        "triangles": len(scan.triangles),
        "bounding_box": {"min": used.min(axis=0).tolist(), "max": used.max(axis=0).tolist()},
        "mean_edge_length": mean_edge_length(mesh),
    }


def describe_hole(hole: Hole) -> dict[str, Any]:
    """Measures of a hole, JSON-ready."""
    return {
        "id": hole.id,
        "edges": hole.n_edges,
        "perimeter": hole.perimeter,
        "diameter": hole.diameter,
        "area": hole.area,
        "planarity": hole.planarity,
        "is_manifold": hole.is_manifold,
        "is_border": hole.is_border,
    }


def build_report(
    scan: Scan, mesh: TriangleMesh, repair: Repair, options: RepairOptions, model: dict[str, Any], stages: Stages
) -> dict[str, Any]:
    """Put everything that a user may want to know about a repair into one JSON-ready object."""
    completion = repair.completion
    return {
        "schema": 1,
        "source": describe_mesh(scan, mesh),
        "length_unit": scan.unit or UNKNOWN_UNIT,
        "model": model,
        "options": asdict(options),
        "counts": {
            "found": len(repair.results),
            **{verdict: sum(r.verdict == verdict for r in repair.results) for verdict in VERDICTS},
        },
        "patches": None
        if completion is None
        else {
            "length": completion.scale.length,
            "resolution": completion.scale.resolution,
            "overlap": completion.scale.overlap,
            "count": completion.n_patches,
            "believed_share": completion.believed,
        },
        "holes": [_hole(result) for result in repair.results],
        "stages": [{"name": name, "seconds": round(seconds, 4)} for name, seconds in stages.seconds.items()],
        "warnings": repair.warnings,
    }


def _hole(result: HoleResult) -> dict[str, Any]:
    return {
        **describe_hole(result.hole),
        "verdict": result.verdict,
        "code": result.code or None,
        "reason": result.reason or None,
        "confidence": result.confidence,
        "expected_error": result.expected_error,
        "fill": result.fill or None,
        "new_vertices": result.n_new_vertices,
        "new_triangles": result.n_new_triangles,
        "measures": result.measures,
    }
