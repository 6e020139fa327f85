"""Fewer triangles for the eye: measured surface is reduced, invented surface stays as it is.

Vertices of equal positions become one. A scan of many more triangles than are wanted is clustered first, since the
collapse of edges would take minutes for millions of them: all vertices within one cell of a grid become one at their
mean, but for those on borders, unless these are long. Edges of what is left are collapsed by their quadric error;
borders, and with them the seams of invented surface, do not move.

References
----------
M. Garland, P. Heckbert, "Surface simplification using quadric error metrics", SIGGRAPH, 1997.
"""

from dataclasses import dataclass

from scipy.spatial import cKDTree

from quadpatch.mesh.meshlab import CollapseOptions, collapse_edges
from quadpatch.mesh.topology import compacted
from quadpatch.mesh.weld import first_of_equal
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles
from quadpatch.views.clustering import cells_of, cluster, join

# Clusters leave so many triangles more than are wanted, as a share of these, and at most; their collapse takes seconds.
# More of them leave fewer folds; where cells hold many vertices, their means leave few in any case.
_SPARE, _MOST_SPARE = 1.0, 200_000
_LARGE, _SPARE_OF_LARGE = 20.0, 0.3
# A scan of less than so many times the triangles that clusters would leave is not clustered.
_CLUSTERED_FROM = 1.5
# Invented surface of at most this share of the wanted triangles stays as it is.
_KEPT_SHARE = 0.6
# In a clustered scan, borders of at most this share of the wanted triangles stay as they are.
_BORDER_SHARE = 0.25


@dataclass(frozen=True)
class Reduction:
    """A reduced surface in two parts.

    Attributes
    ----------
    measured, invented : TriangleMesh
        Vertices on the seam stand in both, at equal positions.
    measured_colours, invented_colours : (n, c) float64 or None
        Of their vertices, in the terms of the input.
    invented_source : (m,) int64
        The triangle of the input that each invented triangle was.
    """

    measured: TriangleMesh
    invented: TriangleMesh
    measured_colours: FloatArray | None
    invented_colours: FloatArray | None
    invented_source: IntArray


def reduce_surface(
    mesh: TriangleMesh,
    is_invented: BoolArray,
    n_triangles: int,
    colours: FloatArray | None = None,
    *,
    is_bounded: bool = False,
) -> Reduction:
    """Reduce a surface to about so many triangles.

    Parameters
    ----------
    mesh : TriangleMesh
        Finite.
    is_invented : (n_triangles,) bool
    n_triangles : int
    colours : (n_vertices, c) float64, optional
        NaN where a vertex has none.
    is_bounded : bool
        Whether invented surface and borders are reduced as well: for meshes that consist of little else.

    Raises
    ------
    StageError
        If MeshLab refuses the mesh.
    """
    n_invented = int(is_invented.sum())
    keeps = n_invented <= _KEPT_SHARE * n_triangles and not is_bounded
    n_measured = len(mesh.triangles) - n_invented
    n_clustered = _n_clustered(n_measured, n_triangles)
    if not keeps:
        label = cells_of(mesh, n_triangles)
    elif n_measured > _CLUSTERED_FROM * n_clustered:
        label = cluster(mesh, n_clustered, is_invented, int(_BORDER_SHARE * n_triangles))
    else:
        label = first_of_equal(mesh.vertices)
    joined, joined_colours, triangles, source = join(mesh, label, colours)
    is_new = is_invented[source]
    n_wanted = max(n_triangles - n_invented, n_triangles // 4)
    measured = _part(joined, joined_colours, triangles[~is_new])
    if keeps and len(measured[0].triangles) > n_wanted:
        measured = _collapsed(*measured, n_wanted)
    invented = _part(joined, joined_colours, triangles[is_new])
    return Reduction(measured[0], invented[0], measured[1], invented[1], source[is_new])


def _n_clustered(n_measured: int, n_triangles: int) -> int:
    """Say how many triangles clusters are to leave of a surface that is to have `n_triangles` in the end."""
    spare = _SPARE_OF_LARGE if n_measured > _LARGE * n_triangles else _SPARE
    return n_triangles + min(int(spare * n_triangles), _MOST_SPARE)


def _part(
    vertices: FloatArray, colours: FloatArray | None, triangles: Triangles
) -> tuple[TriangleMesh, FloatArray | None]:
    used, local = compacted(triangles, len(vertices))
    return TriangleMesh(vertices[used], local), None if colours is None else colours[used]


def _collapsed(
    mesh: TriangleMesh, colours: FloatArray | None, n_triangles: int
) -> tuple[TriangleMesh, FloatArray | None]:
    """Collapse edges; a vertex gets the colour of the nearest one before."""
    collapsed = collapse_edges(mesh, n_triangles, CollapseOptions(keeps_border=True))
    nearest = None if colours is None else colours[cKDTree(mesh.vertices).query(collapsed.vertices)[1]]
    return _part(collapsed.vertices, nearest, collapsed.triangles)
