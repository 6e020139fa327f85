"""What a format with 32-bit coordinates costs a scan that is converted to it.

STL and glTF hold float32, which has 24 binary digits. A scan in coordinates of a survey, far from the origin, loses the
digits of its shape there. The scan's own format keeps its own numbers, so only conversions are looked at.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from quadpatch.errors import PrecisionError
from quadpatch.formats.scan import Scan
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.mesh.normals import cross
from quadpatch.types import BoolArray, FloatArray, TriangleMesh
from quadpatch_rules.coded_warnings import Value, warning

_SINGLE = {"stl": "STL", "glb": "glTF", "gltf": "glTF"}
# A step of rounding above this share of the mean edge length shows in the shape.
VISIBLE_SHARE = 1e-3
# Cosine between the normals of a triangle before and after rounding: one that turns by 60 degrees has lost its shape.
_TURNED = 0.5
# Of the triangles: scans have a few slivers that are thinner than any step.
_MOST_COLLAPSED = 1e-3


def check_precision(scan: Scan, output: Path) -> list[str]:
    """Compare the step of the output's numbers with the edges of a scan.

    Parameters
    ----------
    scan : Scan
    output : Path
        Its suffix says the format.

    Returns
    -------
    list of str
        Warnings: one where rounding moves vertices by more than a thousandth of the mean edge length.

    Raises
    ------
    PrecisionError
        If triangles would lose their area, or turn over.
    """
    suffix = output.suffix.lower().lstrip(".")
    if suffix not in _SINGLE or suffix == scan.format:
        return []
    mesh = TriangleMesh(scan.vertices, scan.triangles)
    step = single_step(scan)
    edge = mean_edge_length(mesh)
    if not step > VISIBLE_SHARE * edge:
        return []
    n_collapsed = int(_collapsed(mesh).sum())
    where = (
        f"{_SINGLE[suffix]} holds 32-bit numbers, which round the coordinates of this mesh to steps of {step:.3g}; "
        f"its mean edge length is {edge:.3g}"
    )
    if n_collapsed > _MOST_COLLAPSED * len(scan.triangles):
        raise PrecisionError(
            f"{where}: {n_collapsed:,} of {len(scan.triangles):,} triangles would collapse. "
            "Take PLY or OBJ, or move the mesh to the origin first"
        )
    values: dict[str, Value] = {"format": _SINGLE[suffix], "step": step, "edge": edge}
    if n_collapsed:
        return [warning("triangles_collapse", **values, collapsed=n_collapsed)]
    return [warning("precision_short", **values)]


def single_step(scan: Scan) -> float:
    """Largest distance between a coordinate that a triangle uses and the next one in float32, in mesh units."""
    largest = np.abs(scan.vertices[scan.triangles]).max(initial=0.0)
    return float(np.spacing(np.float32(largest)))


def _collapsed(mesh: TriangleMesh) -> BoolArray:
    """Triangles (m,) that have an area, and none or another direction once their corners are rounded to float32."""
    # Relative to a corner: far from the origin, products of whole coordinates would round as well.
    before, after = (_area_vectors(v[mesh.triangles]) for v in (mesh.vertices, mesh.vertices.astype(np.float32)))
    cosine = np.einsum("ij,ij->i", before, after)
    lengths = np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
    return np.asarray(before.any(axis=1) & ~(cosine > _TURNED * lengths))


def _area_vectors(corners: NDArray[np.floating]) -> FloatArray:
    exact = corners.astype(np.float64)
    return cross(exact[:, 1] - exact[:, 0], exact[:, 2] - exact[:, 0])
