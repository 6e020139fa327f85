"""Vertices of one label, such as those of one cell of a grid, become one.

References
----------
J. Rossignac, P. Borrel, "Multi-resolution 3D approximations for rendering complex scenes", Modeling in Computer
Graphics, 1993.
"""

import numpy as np

from quadpatch.mesh.edge_survey import survey_edges
from quadpatch.mesh.normals import area_vectors, length
from quadpatch.mesh.passes import extent, parts_of
from quadpatch.mesh.topology import compacted, components, edge_keys, neighbouring_triangles, touching
from quadpatch.mesh.weld import first_of_equal
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles

# Triangles of a clustered surface that may lie folded on others; more of them together are a wall.
_LARGEST_FOLD = 8
# Triangles of a surface after clustering, for each square of a cell that fits into its area: measured on scans.
_TRIANGLES_PER_CELL = 2.65
# Triangles that an area is estimated from, and cells for each vertex up to which a table of them is made.
_SAMPLED, _DENSE = 100_000, 8
# Vertices, or triangles, that are looked at together: what is made of them fits into the processor's cache.
_CHUNK = 1 << 14


def cluster(mesh: TriangleMesh, n_triangles: int, is_kept: BoolArray, most_on_border: int) -> IntArray:
    """Label vertices (n_vertices,) by their cells, but each one of some triangles, or of a border, by itself.

    Parameters
    ----------
    mesh : TriangleMesh
    n_triangles : int
        About how many are to be left of the others.
    is_kept : (n_triangles,) bool
        Triangles that are to stay as they are. Equal positions get one label.
    most_on_border : int
        Where more vertices lie on borders than this, they are clustered as well. Holes narrower than a cell close.
    """
    cells = cells_of(mesh, n_triangles)
    # A file that repeats vertices has more of them than triangles; without, equal positions need not be looked for.
    is_repeated = len(mesh.vertices) > len(mesh.triangles) or is_kept.any()
    label = first_of_equal(mesh.vertices) if is_repeated else np.arange(len(mesh.vertices))
    triangles = label[mesh.triangles] if is_repeated else mesh.triangles
    is_apart = _on_border(triangles, cells)
    if is_apart.sum() > most_on_border:
        is_apart[:] = False
    is_apart[triangles[is_kept]] = True
    apart = np.flatnonzero(is_apart[label])
    cells[apart] = cells.max(initial=-1) + 1 + compacted(label[apart], len(label))[1]
    return cells


def _on_border(triangles: Triangles, cells: IntArray) -> BoolArray:
    """Find vertices (n_vertices,) on borders by those of the clustered surface: looking at all edges takes longer."""
    n_cells = int(cells.max(initial=-1)) + 1
    clustered = _spanning(cells, triangles)[1]
    clustered = clustered[_without_folds(clustered, n_cells)]
    is_near = survey_edges(clustered, n_cells).on_boundary
    is_near[clustered[touching(clustered, is_near)]] = True
    near = is_near[cells]
    used, local = compacted(triangles[touching(triangles, near)], len(cells))
    on_border = np.zeros(len(cells), bool)
    on_border[used] = survey_edges(local, len(used)).on_boundary
    return on_border & near


def cells_of(mesh: TriangleMesh, n_triangles: int) -> IntArray:
    """Cell (n_vertices,) of each vertex, in a grid whose cells leave about so many triangles of the surface."""
    low, high = extent(mesh.vertices)
    cell = np.sqrt(_TRIANGLES_PER_CELL * _estimated_area(mesh) / max(n_triangles, 1))
    # Lines without an area have a length even so; and a cell can't be so small that its number is no integer.
    cell = max(cell, float((high - low).max()) / 1e6, np.finfo(np.float64).tiny)
    sides = np.floor((high - low) / cell).astype(np.int64) + 1
    keys = np.zeros(len(mesh.vertices), np.int64)
    for part in parts_of(len(keys), _CHUNK):
        x, y, z = ((mesh.vertices[part] - low) / cell).astype(np.int64).T
        keys[part] = (x * sides[1] + y) * sides[2] + z
    n_cells = int(sides[0]) * int(sides[1]) * int(sides[2])
    if n_cells > _DENSE * len(keys):
        return np.asarray(np.unique(keys, return_inverse=True)[1], np.int64)
    return compacted(keys, n_cells)[1]


def _estimated_area(mesh: TriangleMesh) -> float:
    step = max(1, len(mesh.triangles) // _SAMPLED)
    some = mesh.triangles[::step]
    return float(length(area_vectors(mesh.vertices, some)).sum()) / 2 * (len(mesh.triangles) / max(len(some), 1))


def join(
    mesh: TriangleMesh, label: IntArray, colours: FloatArray | None
) -> tuple[FloatArray, FloatArray | None, Triangles, IntArray]:
    """Join vertices of one label: vertices (k, 3), colours (k, c), triangles (l, 3), and which they were (l,)."""
    n_labels = int(label.max(initial=-1)) + 1
    kept, triangles = _spanning(label, mesh.triangles)
    used, triangles = compacted(triangles, n_labels)
    first = _without_folds(triangles, len(used))
    number = np.full(n_labels, -1)
    number[used] = np.arange(len(used))
    member = number[label]
    return (
        _means(mesh.vertices, member, len(used)),
        None if colours is None else _means(colours, member, len(used)),
        triangles[first],
        kept[first],
    )


def _spanning(label: IntArray, triangles: Triangles) -> tuple[IntArray, Triangles]:
    """Find the triangles (l,) whose corners have three labels, and these labels (l, 3)."""
    found, corners = [np.zeros(0, np.int64)], [np.zeros((0, 3), np.int64)]
    for part in parts_of(len(triangles), _CHUNK):
        labels = label[triangles[part]]
        a, b, c = labels.T
        kept = np.flatnonzero((a != b) & (b != c) & (c != a))
        found.append(part.start + kept)
        corners.append(labels[kept])
    return np.concatenate(found), np.concatenate(corners)


def _without_folds(triangles: Triangles, n_vertices: int) -> IntArray:
    """Keep one triangle (l,) of each set of corners, turned as most of them are: clusters leave many of each.

    Where as many are turned one way as the other, the surface lies folded on itself: small folds are left out. Large
    ones are thin walls, of which one side is kept.
    """
    start = np.argmin(triangles, axis=1)
    rows = np.arange(len(triangles))
    second, third = triangles[rows, (start + 1) % 3], triangles[rows, (start + 2) % 3]
    turn = np.where(second < third, 1, -1)
    edge = edge_keys(np.stack([second, third], axis=1), n_vertices)
    order = np.lexsort((edge, triangles[rows, start]))
    begins = np.ones(len(triangles), bool)
    begins[1:] = (np.diff(triangles[rows, start][order]) != 0) | (np.diff(edge[order]) != 0)
    group = np.zeros(len(triangles), np.int64)
    group[order] = np.cumsum(begins) - 1
    net_turn = np.sign(np.bincount(group, turn))
    first = np.full(len(net_turn), len(triangles))
    agrees = (net_turn[group] == turn) | (net_turn[group] == 0)
    np.minimum.at(first, group[agrees], rows[agrees])
    folded = first[net_turn == 0]
    fold = components(neighbouring_triangles(triangles[folded])[0], len(folded))
    is_small = np.bincount(fold)[fold] <= _LARGEST_FOLD
    return np.sort(np.concatenate([first[net_turn != 0], folded[~is_small]]))


def _means(values: FloatArray, member: IntArray, n: int) -> FloatArray:
    """Average the rows (m, c) of each of n members (m,), -1 for none; rows that are NaN do not count."""
    is_known = np.isfinite(values[:, 0])
    if not is_known.all():
        member, values = member[is_known], values[is_known]
    # The first bin is for those that are no member.
    member = member + 1
    count = np.bincount(member, minlength=n + 1)[1:]
    totals = [np.bincount(member, weights=column, minlength=n + 1)[1:] for column in values.T]
    return np.asarray(np.stack(totals, axis=1) / np.where(count, count, np.nan)[:, None])
