"""Outlines of holes, to be drawn over a mesh: the rims of all loops, thinned, by the ids that repairs have."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.formats.output_files import write_whole
from quadpatch.mesh.hole_measures import Hole, find_holes
from quadpatch.mesh.measures import bounding_box, diagonal
from quadpatch.repair import read_surface
from quadpatch.report import UNKNOWN_UNIT
from quadpatch.types import FloatArray

# Of one mesh: the widest holes that are drawn, and vertices of all rims together; of each rim between these two.
MOST_HOLES, _MOST_VERTICES, _FEWEST, _MOST = 10_000, 200_000, 12, 512
# Of the mesh's diagonal: what coordinates are rounded to.
_STEP = 1e-6


def write_outlines(source: Path, output: Path) -> None:
    """Write the outlines of a mesh as JSON: `origin`, `length_unit`, `n_holes` and `holes`, the widest first.

    A hole has its `id`, `kind`, `diameter`, `perimeter`, `centre` and `normal`, and `rim`: the vertices (n, 3) of a
    closed polyline, relative to the origin. Lengths in mesh units.

    Raises
    ------
    MeshError
        If the file can't be read, or holds no surface.
    """
    scan, welded = read_surface(source)
    mesh = welded.mesh
    holes = find_holes(mesh, welded.survey)
    low, high = bounding_box(mesh)
    origin = (low + high) / 2
    shown = holes[:MOST_HOLES]
    most = int(np.clip(_MOST_VERTICES // max(len(shown), 1), _FEWEST, _MOST))
    digits = int(np.ceil(-np.log10(_STEP * diagonal(mesh))))
    outlines = {
        "origin": origin.tolist(),
        "length_unit": scan.unit or UNKNOWN_UNIT,
        "n_holes": len(holes),
        "holes": [_outline(hole, mesh.vertices[_thinned(hole, most)] - origin, digits) for hole in shown],
    }
    write_whole(output, json.dumps(outlines, allow_nan=False, separators=(",", ":")).encode())


def _thinned(hole: Hole, most: int) -> Any:
    """Take at most so many vertices of a rim, evenly by their number."""
    n = len(hole.loop)
    return hole.loop if n <= most else hole.loop[np.arange(most) * n // most]


def _outline(hole: Hole, rim: FloatArray, digits: int) -> dict[str, Any]:
    return {
        "id": hole.id,
        "kind": hole.kind,
        "diameter": hole.diameter,
        "perimeter": hole.perimeter,
        "centre": list(hole.centre),
        "normal": list(hole.normal),
        "rim": np.round(rim, digits).tolist(),
        "is_thinned": len(rim) < len(hole.loop),
    }
