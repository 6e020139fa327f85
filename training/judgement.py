"""Judging a model on holes whose surface is known: whole repairs beside the plain fill, as `make bench-quality` does.

Disks are cut out of a mesh, the rest is repaired, and the error is the mean of two distances: from points spread evenly
over the new triangles to the true surface, and from the vertices that were cut away to the repaired one.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.calibration.synthetic_holes import Spacing, UncutSurface, cut_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.formats.output_files import write_whole
from quadpatch.formats.plain import encode_plain_ply
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.measures import longest_side, mean_edge_length
from quadpatch.mesh.sampling import sample_surface
from quadpatch.mesh.topology import compacted
from quadpatch.options import RepairOptions
from quadpatch.repair import repair_and_keep
from quadpatch.types import FloatArray, TriangleMesh, Vertices

# Radius of a hole: that of the benchmark, as a share of the longest side, and no less than so many mean edges.
RADIUS_SHARE, LEAST_RADIUS_EDGES = 0.025, 4.0
MOST_HOLES = 12
_SAMPLES = 20_000
# What lies so many radii around the centre of a hole belongs to it.
_REACH = 1.5


@dataclass(frozen=True)
class KnownHoles:
    """A mesh with holes whose surface is known.

    Attributes
    ----------
    truth : TriangleMesh
        Without the holes.
    punched : Path
        The mesh with the holes, PLY.
    centres : (n_holes, 3) float64
    radius : float
        In mesh units.
    removed : (n_removed, 3) float64
        Vertices of the truth that were cut away.
    """

    truth: TriangleMesh
    punched: Path
    centres: FloatArray
    radius: float
    removed: Vertices


def cut_known_holes(mesh: TriangleMesh, punched: Path, rng: np.random.Generator) -> KnownHoles | None:
    """Cut holes into a mesh, and write what remains.

    Parameters
    ----------
    mesh : TriangleMesh
    punched : Path
        File to write.
    rng : numpy.random.Generator
        Picks the places.

    Returns
    -------
    KnownHoles or None
        None where the mesh has no room for one; nothing is written then.
    """
    edge_length = mean_edge_length(mesh)
    radius = max(RADIUS_SHARE * longest_side(mesh), LEAST_RADIUS_EDGES * edge_length)
    cut = cut_holes(UncutSurface(mesh), 2 * radius, Spacing(edge_length, radius, MOST_HOLES), rng)
    if not cut.loops:
        return None
    used, triangles = compacted(cut.mesh.triangles, len(mesh.vertices))
    write_whole(punched, encode_plain_ply(TriangleMesh(mesh.vertices[used], triangles), None))
    centres = np.array([mesh.vertices[loop].mean(axis=0) for loop in cut.loops])
    return KnownHoles(mesh, punched, centres, radius, mesh.vertices[cut.removed])


def repair_error(holes: KnownHoles, model: str | Path, seed: int) -> float:
    """Repair the holes by a model and measure the error, in mesh units.

    Parameters
    ----------
    holes : KnownHoles
    model : str or Path
        As `quadpatch.repair.repair_file` takes it; `smooth` is the plain fill.
    seed : int

    Raises
    ------
    QuadpatchError
        If the mesh can't be repaired.
    """
    repaired = holes.punched.with_name(f"{holes.punched.stem}-repaired.ply")
    options = RepairOptions(seed=seed)
    filled = repair_and_keep(holes.punched, repaired, model, options).repair.filled
    repaired.unlink(missing_ok=True)
    completeness = distance_to_mesh(holes.removed, filled.mesh).mean()
    points = _new_surface(filled, holes)
    accuracy = distance_to_mesh(points, holes.truth).mean() if len(points) else completeness
    return float(0.5 * (accuracy + completeness))


def _new_surface(filled: FilledMesh, holes: KnownHoles) -> Vertices:
    """Draw points of what was inserted into the holes; holes that the mesh had before have no known surface."""
    inserted = TriangleMesh(filled.mesh.vertices, filled.mesh.triangles[filled.n_measured_triangles :])
    points, _ = sample_surface(inserted, _SAMPLES, np.random.default_rng(0))
    if not len(points):
        return points
    return points[cKDTree(holes.centres).query(points)[0] < _REACH * holes.radius]
