"""A filled mesh made so fine that its vertices show the texture: samples of the surface, with the colours of images.

Tested in `tests/quadpatch/textures/test_painting.py`.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.edge_splitting import SplitMesh, split_long_edges
from quadpatch.mesh.measures import edge_statistics, surface_area
from quadpatch.textures.measured_texture import MeasuredTexture
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh

# Edges are at most so many texels long: those of most samples are then as long as texels are wide.
_LONGEST_EDGE = 1.4
# Samples of a surface, in units of its area over the square of the longest edge: those of meshes that were split.
_SAMPLES = 3.2
# Where the surface would have more samples, they lie less dense, and what is painted is less sharp.
MOST_SAMPLES = 600_000
# Longest edges that are tried for the fills, in those of what was measured. Halving leaves edges of one mesh longer
# than those of another; a texture has the same gradients only on samples that lie equally dense.
_FILL_EDGES = (1.0, 0.9, 0.8, 0.7, 0.6, 0.5)


@dataclass(frozen=True)
class Samples:
    """Samples of a filled mesh.

    Attributes
    ----------
    filled : FilledMesh
        Samples for vertices.
    colours : (n_measured, c) float64
        0..255; NaN where there is no texture, but never at rims, if there is any.
    parent : (l,) int64
        New triangle of the coarse mesh that each new triangle lies in.
    corners : (l, 3, 3) float64
        Barycentric coordinates of its corners there.
    """

    filled: FilledMesh
    colours: FloatArray
    parent: IntArray
    corners: FloatArray


def take_samples(measured: MeasuredTexture, texel: float) -> Samples:
    """Sample a filled mesh with a texture whose texels are so wide, in mesh units."""
    filled = measured.filled
    longest = max(_LONGEST_EDGE * texel, float(np.sqrt(_SAMPLES * surface_area(filled.mesh) / MOST_SAMPLES)))
    split = split_long_edges(filled.mesh, _edges_of_vertices(filled, longest))
    is_new = split.parent >= filled.n_measured_triangles
    fine, parent = _ordered(filled, split)
    triangle, weights = _places(split, ~is_new, fine)
    colours = _without_bare_rims(fine, measured.colours_at(triangle, weights))
    return Samples(fine, colours, parent, split.corners[is_new])


def _edges_of_vertices(filled: FilledMesh, longest: float) -> FloatArray:
    """Choose longest edges for new vertices (n_vertices,), those of measured ones given, so that means are the same."""
    wanted = edge_statistics(split_long_edges(filled.measured, longest).mesh).mean
    new = TriangleMesh(filled.mesh.vertices, filled.mesh.triangles[filled.n_measured_triangles :])
    best, least = np.full(len(new.vertices), longest), np.inf
    for factor in _FILL_EDGES:
        tried = np.full(len(new.vertices), longest)
        tried[filled.n_measured_vertices :] *= factor
        difference = abs(edge_statistics(split_long_edges(new, tried).mesh).mean - wanted)
        if difference < least:
            best, least = tried, difference
    return best


def _ordered(filled: FilledMesh, split: SplitMesh) -> tuple[FilledMesh, IntArray]:
    """Put measured samples and triangles first; also the new triangle that each new one lies in."""
    is_new = split.parent >= filled.n_measured_triangles
    measured, new = split.mesh.triangles[~is_new], split.mesh.triangles[is_new]
    rank = np.full(len(split.mesh.vertices), 2)
    rank[new] = 1
    rank[measured] = 0
    order = np.argsort(rank, kind="stable")[: int((rank < 2).sum())]
    number = np.zeros(len(rank), np.int64)
    number[order] = np.arange(len(order))
    parent = split.parent[is_new] - filled.n_measured_triangles
    hole = filled.triangle_hole[parent]
    hole_of_vertex = np.zeros(len(order), np.int64)
    hole_of_vertex[number[new]] = hole[:, np.newaxis]
    n_measured = int((rank == 0).sum())
    mesh = TriangleMesh(split.mesh.vertices[order], number[np.concatenate([measured, new])])
    fine = replace(
        filled,
        mesh=mesh,
        n_measured_vertices=n_measured,
        n_measured_triangles=len(measured),
        triangle_hole=hole,
        vertex_hole=hole_of_vertex[n_measured:],
    )
    return fine, parent


def _places(split: SplitMesh, is_measured: BoolArray, fine: FilledMesh) -> tuple[IntArray, FloatArray]:
    """Find a triangle (n_measured,) that each measured sample lies in, and its coordinates (n_measured, 3) there."""
    corner = np.zeros(fine.n_measured_vertices, np.int64)
    named = fine.mesh.triangles[: fine.n_measured_triangles].ravel()
    # Back to front, so that the first triangle of the mesh stays.
    corner[named[::-1]] = np.arange(len(named))[::-1]
    return split.parent[is_measured][corner // 3], split.corners[is_measured].reshape(-1, 3)[corner]


def _without_bare_rims(fine: FilledMesh, colours: FloatArray) -> FloatArray:
    """Give samples at rims that have no colour that of the nearest sample that has one."""
    new = fine.mesh.triangles[fine.n_measured_triangles :]
    rim = np.unique(new[new < fine.n_measured_vertices])
    has = np.asarray(np.isfinite(colours).all(axis=1))
    bare = rim[~has[rim]]
    if len(bare) and has.any():
        known = np.flatnonzero(has)
        _, nearest = cKDTree(fine.mesh.vertices[known]).query(fine.mesh.vertices[bare])
        colours[bare] = colours[known[nearest]]
    return colours
