"""Refinement of a hole's triangulation to the density of the surface around it.

A triangle whose centroid lies far from its corners, compared with
the edge lengths at the rim, is split there; after every round, interior edges are flipped until they are locally
Delaunay. All holes are refined at once, so every step is one pass over arrays.

References
----------
P. Liepa, "Filling Holes in Meshes", Eurographics Symposium on Geometry Processing, 2003, section 4.
"""

from dataclasses import dataclass, replace

import numpy as np

from quadpatch.filling.edge_flips import delaunay
from quadpatch.filling.triangulation import EdgeSet
from quadpatch.mesh.averages import mean_of_corners
from quadpatch.mesh.normals import length, vertex_normals
from quadpatch.mesh.smoothing import neighbour_average
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices

# Liepa's density factor: larger gives more vertices. With his sqrt(2) a fill has fewer vertices than were lost (0.60 to
# 0.77 of them on scans) and an error 1 to 6 % higher; with 2 it has 1.4 to 2.0 times as many. Beyond, little changes.
DENSITY = 2.0

_MAX_ROUNDS = 24

# Grading: wanted edge lengths grow by this factor from vertex to vertex, up to this share of the hole's diameter. With
# them, energies rank as on uniform fills (errors in relation to the best differ by 1 % on scans), at a seventh of the
# vertices where holes are 42 edges wide.
_GROWTH = 1.5
_SHARE_OF_DIAMETER = 0.1


@dataclass(frozen=True)
class Grading:
    """Wanted edge lengths that grow from the rims into the holes: for fills that are measured and thrown away.

    Attributes
    ----------
    finest : (n_holes,) float64
        Mean at the rim, in mesh units.
    coarsest : (n_holes,) float64
        Where they stop to grow.
    """

    finest: FloatArray
    coarsest: FloatArray

    @classmethod
    def of(cls, spacing: FloatArray, vertices: Vertices, loops: list[IntArray]) -> "Grading | None":
        """Grade holes by the wanted edge lengths (n,) at their rims; None if none of them is large for its edges."""
        finest = np.array([spacing[loop].mean() for loop in loops], np.float64)
        extents = np.array([np.ptp(vertices[loop], axis=0) for loop in loops]).reshape(-1, 3)
        coarsest = np.maximum(_SHARE_OF_DIAMETER * length(extents), finest)
        return cls(finest, coarsest) if (coarsest > finest).any() else None

    def grown(self, spacing: FloatArray, hole: IntArray) -> FloatArray:
        """Wanted edge length (k,) at new vertices of some holes (k,) between corners of this mean (k,)."""
        return np.maximum(spacing, np.minimum(_GROWTH * spacing, self.coarsest[hole]))


@dataclass(frozen=True)
class Refined:
    """Triangulations of all holes, being refined.

    Attributes
    ----------
    vertices : (n, 3) float64
        Input vertices first; only those after them are ever added or moved.
    triangles : (m, 3) int64
    hole : (m,) int64
        Position of each triangle's hole in the list of loops.
    spacing : (n,) float64
        Wanted edge length at each vertex; 0 where no hole touches it.
    n_measured : int
        Count of input vertices.
    grading : Grading, optional
        Without, fills are as dense inside as at their rims.
    """

    vertices: Vertices
    triangles: Triangles
    hole: IntArray
    spacing: FloatArray
    n_measured: int
    grading: Grading | None = None

    @property
    def is_new(self) -> BoolArray:
        """(n,) bool, True = added by the refinement."""
        return np.arange(len(self.vertices)) >= self.n_measured


def refine(patch: Refined, existing_edges: EdgeSet, rim: Triangles | None = None, *, flip: bool = True) -> Refined:
    """Split and flip until every triangle is about as large as the surface around its hole is dense.

    Parameters
    ----------
    patch : Refined
    existing_edges : EdgeSet
    rim : (k, 3) int64, optional
        See `flip_to_delaunay`.
    flip : bool
        Without flips the surface stays where it is.
    """
    patch = flip_to_delaunay(patch, existing_edges, rim) if flip else patch
    for _ in range(_MAX_ROUNDS):
        large = _too_large(patch)
        if not large.any():
            break
        patch = _split_at_centroid(patch, large)
        patch = flip_to_delaunay(patch, existing_edges, rim) if flip else patch
    return patch


def _too_large(patch: Refined) -> BoolArray:
    corners = patch.vertices[patch.triangles]
    reach = DENSITY * length(corners - mean_of_corners(corners)[:, None])
    wanted = patch.spacing[patch.triangles]
    a, b, c = ((reach > wanted) & (reach > mean_of_corners(wanted)[:, None])).T
    return np.asarray(a & b & c)


def _split_at_centroid(patch: Refined, large: BoolArray) -> Refined:
    a, b, c = patch.triangles[large].T
    new = len(patch.vertices) + np.arange(len(a))
    inner = np.concatenate([np.stack(t, axis=1) for t in ((a, b, new), (b, c, new), (c, a, new))])
    corners, hole = patch.triangles[large], patch.hole[large]
    spacing = mean_of_corners(patch.spacing[corners])
    if patch.grading is not None:
        spacing = patch.grading.grown(spacing, hole)
    return replace(
        patch,
        vertices=np.concatenate([patch.vertices, mean_of_corners(patch.vertices[corners])]),
        triangles=np.concatenate([patch.triangles[~large], inner]),
        hole=np.concatenate([patch.hole[~large], np.tile(hole, 3)]),
        spacing=np.concatenate([patch.spacing, spacing]),
    )


def relax(
    patch: Refined, adjacent_triangles: Triangles, existing_edges: EdgeSet, rim: Triangles | None = None
) -> Refined:
    """Slide new vertices along the surface to the mean of their neighbours, and flip again: better shaped triangles.

    Parameters
    ----------
    patch : Refined
    adjacent_triangles : (k, 3) int64
        Triangles of the input next to the holes.
    existing_edges : EdgeSet
    rim : (k, 3) int64, optional
        See `flip_to_delaunay`.
    """
    triangles = np.concatenate([adjacent_triangles, patch.triangles])
    mean = neighbour_average(triangles, len(patch.vertices)) @ patch.vertices
    normals = vertex_normals(patch.vertices, triangles)
    slide = mean - patch.vertices
    slide -= np.einsum("ij,ij->i", slide, normals)[:, None] * normals
    slide[~patch.is_new] = 0
    return flip_to_delaunay(replace(patch, vertices=patch.vertices + slide), existing_edges, rim)


def flip_to_delaunay(patch: Refined, existing_edges: EdgeSet, rim: Triangles | None = None) -> Refined:
    """Flip interior edges until all are locally Delaunay; each pass flips edges that share no triangle.

    Parameters
    ----------
    patch : Refined
    existing_edges : EdgeSet
        Edges that exist already.
    rim : (k, 3) int64, optional
        Triangles of the input next to the holes. With them, no flip makes a turn beyond `MOST_TURN_DEG` or makes one
        sharper.
    """
    shared = _in_several_holes(patch)
    return replace(patch, triangles=delaunay(patch.triangles, patch.vertices, shared, existing_edges, rim))


def _in_several_holes(patch: Refined) -> BoolArray:
    """Vertices (n,) on the rims of more than one hole: another one may have the edge between two of them already."""
    last = np.zeros(len(patch.vertices), np.int64)
    last[patch.triangles] = patch.hole[:, None]
    shared = np.zeros(len(patch.vertices), bool)
    shared[patch.triangles[last[patch.triangles] != patch.hole[:, None]]] = True
    return shared
