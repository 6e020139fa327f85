"""Cells: pieces of gaps that one patch covers."""

from dataclasses import dataclass

import numpy as np

from quadpatch.colours.gap_graph import GapGraph
from quadpatch.colours.surface import ColouredSurface
from quadpatch.mesh.averages import mean_by
from quadpatch.mesh.normals import unit
from quadpatch.patches.seeds import Seeds
from quadpatch.types import FloatArray, Frames, IntArray, Vertices

# A cell reaches so many mean edges from its seed at most, and its patch so many beyond.
WIDEST_CELL = 12.0
MARGIN = 3.0
# A cell of one vertex is laid out like a hole of this radius, in mean edges.
_LEAST_CELL = 2.0


@dataclass(frozen=True)
class Cells:
    """Pieces of gaps.

    Attributes
    ----------
    of_vertex : (n,) int64
        Cell of each vertex of a `GapGraph`.
    seeds : Seeds
        One for each cell; `quad` is its gap.
    """

    of_vertex: IntArray
    seeds: Seeds


def gap_radii(surface: ColouredSurface, graph: GapGraph) -> FloatArray:
    """Say how far the vertices of each gap lie from its middle, (n_gaps,) in mesh units; 0 for gaps of other graphs."""
    centres = _centres(surface, graph)
    distance = np.linalg.norm(surface.mesh.vertices[graph.vertices] - centres[graph.gap], axis=1)
    radii = np.zeros(surface.n_gaps)
    np.maximum.at(radii, graph.gap, distance)
    return radii


def cell_radius(surface: ColouredSurface, graph: GapGraph) -> float:
    """Choose how far cells reach from their seeds: as far as three of four gaps do, within bounds; in mesh units."""
    typical = float(np.percentile(gap_radii(surface, graph)[np.unique(graph.gap)], 75))
    return float(np.clip(typical, _LEAST_CELL * surface.edge_length, WIDEST_CELL * surface.edge_length))


def divide(surface: ColouredSurface, graph: GapGraph, radius: float) -> Cells:
    """Divide gaps into cells whose vertices lie within a radius (mesh units) of their seed.

    A seed is the vertex nearest to the middle of its gap, and as long as one lies too far from all seeds, the farthest
    (T. Gonzalez, "Clustering to minimize the maximum intercluster distance", 1985).
    """
    points = surface.mesh.vertices[graph.vertices]
    centres = _centres(surface, graph)
    of_vertex = np.zeros(len(points), np.int64)
    origins: list[int] = []
    order = np.argsort(graph.gap, kind="stable")
    bounds = np.flatnonzero(np.diff(graph.gap[order], prepend=-1, append=-1))
    # Loops over gaps and cells.
    for start, end in zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True):
        members = order[start:end]
        place = points[members]
        seed = int(np.linalg.norm(place - centres[graph.gap[members[0]]], axis=1).argmin())
        nearest = np.full(len(members), np.inf)
        while True:
            distance = np.linalg.norm(place - place[seed], axis=1)
            closer = distance < nearest
            nearest[closer] = distance[closer]
            of_vertex[members[closer]] = len(origins)
            origins.append(int(members[seed]))
            seed = int(nearest.argmax())
            if nearest[seed] <= radius:
                break
    chosen = np.array(origins, np.int64)
    normals = _mean_normals(of_vertex, surface.normals[graph.vertices], len(chosen))
    return Cells(of_vertex, Seeds(points[chosen], frames_along(normals), graph.gap[chosen]))


def frames_along(normals: FloatArray, turns: FloatArray | None = None) -> Frames:
    """Make reference frames (k, 3, 3) along normals (k, 3), turned about them by angles (k,) in radians."""
    z = unit(normals)
    # The axis of the smallest component is the one that z can't be parallel to.
    x = unit(np.cross(np.eye(3)[np.abs(z).argmin(axis=1)], z))
    y = np.cross(z, x)
    if turns is not None:
        cosine, sine = np.cos(turns)[:, np.newaxis], np.sin(turns)[:, np.newaxis]
        x, y = cosine * x + sine * y, cosine * y - sine * x
    return np.stack([x, y, z], axis=1)


def _centres(surface: ColouredSurface, graph: GapGraph) -> Vertices:
    points = surface.mesh.vertices[graph.vertices]
    return np.stack([mean_by(graph.gap, points[:, axis], surface.n_gaps) for axis in range(3)], axis=1)


def _mean_normals(group: IntArray, normals: FloatArray, n_groups: int) -> FloatArray:
    mean = np.stack([mean_by(group, normals[:, axis], n_groups) for axis in range(3)], axis=1)
    # Normals that cancel out say nothing: any direction will do.
    mean[~mean.any(axis=1)] = (0.0, 0.0, 1.0)
    return mean
