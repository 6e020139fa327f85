"""The quad mesh of a file: edge collapse by MeshLab, then triangles paired to quads.

Quads of one size, as a repair uses them, cut off whatever is thinner than a quad. Edge collapse makes small quads where
the surface bends and large ones where it is flat, and keeps the topology, borders included.

References
----------
M. Garland, P. Heckbert, "Surface simplification using quadric error metrics", SIGGRAPH 1997; M. Tarini, N. Pietroni,
P. Cignoni, D. Panozzo, E. Puppo, "Practical quad mesh simplification", Computer Graphics Forum 29, 2010 (pairs of
triangles, and the cut of what is left).
"""

import numpy as np

from quadpatch.errors import NoQuadsError
from quadpatch.mesh.meshlab import CollapseOptions, collapse_edges
from quadpatch.mesh.topology import directed_edges, edge_keys
from quadpatch.quads.vertex_clustering import split_fans
from quadpatch.types import BoolArray, FloatArray, IntArray, QuadMesh, Quads, TriangleMesh, Vertices

# Weight of the planes that hold the border in its place.
_BORDER_WEIGHT = 3.0
# From 0 to 1: how strongly slivers are avoided.
_QUALITY = 0.5
# No surface is collapsed further.
_FEWEST_TRIANGLES = 4
# A smaller part of the mean quad's area is no quad.
_LEAST_AREA = 1e-6


def collapse(mesh: TriangleMesh, n_triangles: int) -> TriangleMesh:
    """Collapse edges until about so many triangles are left.

    Parameters
    ----------
    mesh : TriangleMesh
        Finite. Where it is not a manifold it is cut: every fan of triangles gets vertices of its own.
    n_triangles : int
        A mesh with fewer stays as it is.
    """
    original, triangles = split_fans(mesh.triangles)
    if len(triangles) <= n_triangles:
        return TriangleMesh(mesh.vertices[original], triangles)
    whole = TriangleMesh(mesh.vertices[original], triangles)
    return collapse_edges(whole, n_triangles, CollapseOptions(_QUALITY, _BORDER_WEIGHT, keeps_topology=True))


def collapse_to_quads(mesh: TriangleMesh, n_quads: int) -> QuadMesh:
    """Cover a surface with about so many quads.

    Edges are collapsed until half as many triangles are left. Pairs of these that make a good quad are joined, best
    ones first, and all polygons are cut from their centroid to the midpoints of their edges: a quad into four, a
    triangle that found no partner into three. So there are quads alone, and none of their edges has a gap.

    Parameters
    ----------
    mesh : TriangleMesh
        As for `collapse`.
    n_quads : int
        Pieces keep a few quads each, however few are asked for.

    Returns
    -------
    QuadMesh
        Four different corners and some area in every quad, turned as the triangles are; no vertex without a quad.

    Raises
    ------
    NoQuadsError
        If no quad comes out.
    """
    coarse = collapse(mesh, max(n_quads // 2, _FEWEST_TRIANGLES))
    pairs, joined = _paired(coarse)
    is_single = np.ones(len(coarse.triangles), np.bool_)
    is_single[pairs] = False
    vertices, quads = _cut(coarse.vertices, [joined, coarse.triangles[is_single]])
    quads = quads[_is_proper(vertices, quads)]
    if not len(quads):
        raise NoQuadsError("the surface is too small or too thin to carry one quad")
    used, compact = np.unique(quads, return_inverse=True)
    return QuadMesh(vertices[used], compact.reshape(-1, 4).astype(np.int64))


def _paired(mesh: TriangleMesh) -> tuple[IntArray, Quads]:
    """Choose pairs of triangles (n, 2), and the quads (n, 4) that they make."""
    triangles = mesh.triangles
    edges = directed_edges(triangles)
    order = np.argsort(edge_keys(edges, len(mesh.vertices)), kind="stable")
    keys = edge_keys(edges, len(mesh.vertices))[order]
    first = np.flatnonzero(np.diff(keys, prepend=-1))
    first = first[np.diff(first, append=len(keys)) == 2]
    one, other = order[first], order[first + 1]
    is_opposite = edges[one, 0] == edges[other, 1]
    one, other = one[is_opposite], other[is_opposite]
    apex, across = (triangles[edge // 3, (edge % 3 + 2) % 3] for edge in (one, other))
    quads = np.stack([edges[one, 0], across, edges[one, 1], apex], axis=1)
    chosen, is_taken = [], np.zeros(len(triangles), np.bool_)
    # Best quads first; there are a few thousand at most.
    for k in np.argsort(_distortion(mesh.vertices, quads), kind="stable").tolist():
        pair = one[k] // 3, other[k] // 3
        if apex[k] != across[k] and not is_taken[list(pair)].any():
            is_taken[list(pair)] = True
            chosen.append(k)
    return np.stack([one[chosen] // 3, other[chosen] // 3], axis=1), quads[chosen]


def _distortion(vertices: Vertices, quads: Quads) -> FloatArray:
    """Sum of the absolute cosines at the corners of quads, and how far their two halves are bent: 0 for a rectangle."""
    corners = vertices[quads]
    side = np.roll(corners, -1, axis=1) - corners
    side /= np.maximum(np.linalg.norm(side, axis=2, keepdims=True), np.finfo(np.float64).tiny)
    cosines = np.abs(np.einsum("nij,nij->ni", side, np.roll(side, 1, axis=1))).sum(axis=1)
    halves = [np.cross(side[:, k - 1], side[:, k]) for k in (1, 3)]
    lengths = [np.maximum(np.linalg.norm(half, axis=1), np.finfo(np.float64).tiny) for half in halves]
    return np.asarray(cosines + 1.0 - np.einsum("ij,ij->i", *halves) / (lengths[0] * lengths[1]))


def _cut(vertices: Vertices, polygons: list[IntArray]) -> tuple[Vertices, Quads]:
    """Cut polygons, given by their count of corners, into as many quads as they have corners."""
    n = len(vertices)
    keys = [edge_keys(np.stack([p, np.roll(p, -1, axis=1)], axis=2).reshape(-1, 2), n) for p in polygons]
    unique, edge = np.unique(np.concatenate(keys), return_inverse=True)
    midpoints = (vertices[unique // n] + vertices[unique % n]) / 2
    centroids = [vertices[p].mean(axis=1) for p in polygons]
    quads = []
    first_edge, centre = 0, n + len(unique)
    for table in polygons:
        beside = n + edge[first_edge : first_edge + table.size].reshape(table.shape)
        middle = centre + np.arange(len(table))
        quads += [
            np.stack([table[:, k], beside[:, k], middle, beside[:, k - 1]], axis=1) for k in range(table.shape[1])
        ]
        first_edge, centre = first_edge + table.size, centre + len(table)
    return np.concatenate([vertices, midpoints, *centroids]), np.concatenate(quads)


def _is_proper(vertices: Vertices, quads: Quads) -> BoolArray:
    """Four different corners, finite, and some area."""
    ranked = np.sort(quads, axis=1)
    area = np.linalg.norm(
        np.cross(vertices[quads[:, 2]] - vertices[quads[:, 0]], vertices[quads[:, 3]] - vertices[quads[:, 1]]), axis=1
    )
    mean = float(area[np.isfinite(area)].mean()) if np.isfinite(area).any() else 0.0
    return np.asarray((ranked[:, 1:] != ranked[:, :-1]).all(axis=1) & (area > _LEAST_AREA * mean))
