"""From a mesh file, or a repaired one and its report, to a file for a viewer.

A viewer gets the surface in two levels: a coarse one that is there at once, and a finer one. Both are bounded in bytes.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np

from quadpatch.errors import EmptyMeshError
from quadpatch.formats.output_files import write_whole
from quadpatch.formats.reading import read_scan
from quadpatch.formats.scan import Scan
from quadpatch.formats.units import METRES
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.measures import bounding_box
from quadpatch.mesh.topology import compacted
from quadpatch.report import UNKNOWN_UNIT
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh
from quadpatch.views.fills import holes_of, is_added, is_behind
from quadpatch.views.glb import Part, encode_parts
from quadpatch.views.reduction import Reduction, reduce_surface

LevelName = Literal["coarse", "fine"]

# Formats in which a fill may stand between triangles that were there before.
_WITH_PARTS = ("glb", "gltf", "3mf")
# Colours of glTF are linear; files of other formats hold those of a screen.
_LINEAR = ("glb", "gltf")
UNKNOWN = -1.0


@dataclass(frozen=True)
class Level:
    """How much a file may hold: about so many triangles, and at most so many bytes."""

    n_triangles: int
    n_bytes: int


LEVELS: Mapping[LevelName, Level] = dict(
    zip(get_args(LevelName), (Level(70_000, 2_000_000), Level(700_000, 20_000_000)), strict=True)
)


@dataclass(frozen=True)
class Repaired:
    """The files of a repair: its result, its report, and the mesh that was repaired."""

    result: Path
    report: Path
    source: Path


@dataclass(frozen=True)
class _Surface:
    """What is to be shown; lengths in the unit of the mesh that was uploaded.

    `holes` are rows of a report, and `invented_hole` (n_invented,) int64 is the id of each invented triangle's hole.
    """

    mesh: TriangleMesh
    is_invented: BoolArray
    invented_hole: IntArray
    colours: FloatArray | None
    has_linear_colours: bool
    unit: str
    holes: list[dict[str, Any]]


def write_mesh_view(source: Path, output: Path, level: LevelName) -> None:
    """Write the view of a mesh.

    Raises
    ------
    MeshError
        If the file can't be read, or holds no surface.
    """
    scan = read_scan(source)
    surface = _surface_of(scan, np.zeros(len(scan.triangles), bool), 1.0, scan.unit or UNKNOWN_UNIT, [])
    write_whole(output, _encode(surface, level, None))


def write_repair_view(repaired: Repaired, output: Path, level: LevelName, reference: Path | None = None) -> None:
    """Write the view of a finished job.

    Parameters
    ----------
    repaired : Repaired
        Of a task that fills no holes, all of the surface counts as measured.
    output : Path
    level : str
    reference : Path, optional
        A mesh in the same place and unit: each vertex gets its distance to it.

    Raises
    ------
    MeshError
        If a file can't be read, or holds no surface.
    """
    report = json.loads(repaired.report.read_bytes())
    scan = read_scan(repaired.result)
    unit = report["length_unit"]
    is_converted = scan.format in _LINEAR and report["source"]["format"] not in _LINEAR
    scale = METRES.get(unit, 1.0) if is_converted else 1.0
    holes = report.get("holes", [])
    target = None if reference is None else _mesh_of(read_scan(reference))
    surface = _surface_of(scan, _invented(scan, repaired, report, holes), scale, unit, holes)
    write_whole(output, _encode(surface, level, target))


def _invented(scan: Scan, repaired: Repaired, report: dict[str, Any], holes: list[dict[str, Any]]) -> BoolArray:
    if not holes:
        return np.zeros(len(scan.triangles), bool)
    if scan.format in _WITH_PARTS and report["source"]["format"] in _WITH_PARTS:
        return is_added(_mesh_of(scan), _mesh_of(read_scan(repaired.source)))
    return is_behind(len(scan.triangles), report)


def _mesh_of(scan: Scan) -> TriangleMesh:
    return TriangleMesh(scan.vertices, scan.triangles)


def _surface_of(scan: Scan, is_invented: BoolArray, scale: float, unit: str, holes: list[dict[str, Any]]) -> _Surface:
    colours = None if scan.source is None else scan.source.vertex_colours(scan)
    mesh = TriangleMesh(scan.vertices if scale == 1.0 else scan.vertices / scale, scan.triangles)
    used, local = compacted(mesh.triangles[is_invented], len(mesh.vertices))
    return _Surface(
        mesh,
        is_invented,
        holes_of(mesh.vertices[used], local, holes),
        None if colours is None else colours[:, :3],
        scan.format in _LINEAR,
        unit,
        holes,
    )


def _encode(surface: _Surface, level_name: LevelName, reference: TriangleMesh | None) -> bytes:
    """Encode a surface; where it is too large, with all of it reduced, until it is not."""
    level = LEVELS[level_name]
    n_triangles, is_bounded = level.n_triangles, False
    while True:
        reduced = reduce_surface(surface.mesh, surface.is_invented, n_triangles, surface.colours, is_bounded=is_bounded)
        encoded = _encode_reduced(surface, reduced, level_name, reference)
        if len(encoded) <= level.n_bytes:
            return encoded
        n_left = len(reduced.measured.triangles) + len(reduced.invented.triangles)
        n_triangles, is_bounded = int(0.8 * n_left * level.n_bytes / len(encoded)), True


def _encode_reduced(surface: _Surface, reduced: Reduction, level: LevelName, reference: TriangleMesh | None) -> bytes:
    n_left = len(reduced.measured.triangles) + len(reduced.invented.triangles)
    if not n_left:
        raise EmptyMeshError("the mesh has no triangle with three different corners")
    low, high = bounding_box(surface.mesh)
    parts = [
        Part("measured", reduced.measured, _linear(reduced.measured_colours, surface), {}),
        Part(
            "invented",
            reduced.invented,
            _linear(reduced.invented_colours, surface),
            _hole_values(surface, reduced),
        ),
    ]
    if reference is not None:
        parts = [_with_distance(part, reference) for part in parts]
    about = {
        "length_unit": surface.unit,
        "level": level,
        "triangles": len(surface.mesh.triangles),
        "vertices": len(surface.mesh.vertices),
        "is_reduced": n_left < len(surface.mesh.triangles),
        "bounding_box": {"min": low.tolist(), "max": high.tolist()},
        "has_colours": surface.colours is not None,
    }
    return encode_parts(parts, (low + high) / 2, about)


def _with_distance(part: Part, reference: TriangleMesh) -> Part:
    distance = distance_to_mesh(part.mesh.vertices, reference)
    return Part(part.name, part.mesh, part.colours, {**part.values, "_DISTANCE_TO_REFERENCE": distance})


def _hole_values(surface: _Surface, reduced: Reduction) -> dict[str, FloatArray]:
    """Give each vertex what the report says of its hole; `UNKNOWN` where it says nothing."""
    if not len(reduced.invented.triangles):
        return {}
    position = np.cumsum(surface.is_invented) - 1
    hole = np.full(len(reduced.invented.vertices), int(UNKNOWN))
    hole[reduced.invented.triangles] = surface.invented_hole[position[reduced.invented_source]][:, None]
    rows = {row["id"]: row for row in surface.holes}
    return {
        "_HOLE_ID": hole.astype(np.float64),
        "_CONFIDENCE": _looked_up(hole, {id_: row["confidence"] for id_, row in rows.items()}),
        "_EXPECTED_ERROR": _looked_up(hole, {id_: row["expected_error"] for id_, row in rows.items()}),
        "_DISTANCE_TO_PLAIN_FILL": _looked_up(hole, {id_: _departure(row) for id_, row in rows.items()}),
    }


def _departure(row: dict[str, Any]) -> float | None:
    """Mean length by which a model moved a fill off the plain one; 0 where geometry alone made it."""
    departure: float | None = row["measures"].get("departure") if row["verdict"] == "filled" else 0.0
    return departure


def _looked_up(hole: IntArray, known: dict[int, float | None]) -> FloatArray:
    ids, at = np.unique(hole, return_inverse=True)
    values = [known.get(int(id_)) for id_ in ids]
    return np.array([UNKNOWN if value is None else value for value in values])[at.reshape(-1)]


def _linear(colours: FloatArray | None, surface: _Surface) -> FloatArray | None:
    """Turn colours 0..255 into linear ones 0..1 (IEC 61966-2-1); white where there is none."""
    if colours is None:
        return None
    shares = np.clip(np.nan_to_num(colours, nan=255.0) / 255.0, 0.0, 1.0)
    if surface.has_linear_colours:
        return shares
    return np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)
