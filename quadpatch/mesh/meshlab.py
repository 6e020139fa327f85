"""MeshLab's filters; the one place that talks to pymeshlab.

The paper names MeshLab for its hole filling and its smoothing, and both are MeshLab's here. Every call works on a mesh
of its own, in float64, on one thread. Importing pymeshlab takes half a second, so it is put off until a filter is asked
for.

References
----------
P. Cignoni, M. Callieri, M. Corsini, M. Dellepiane, F. Ganovelli, G. Ranzuglia, "MeshLab: an open-source mesh processing
tool", Eurographics Italian Chapter Conference, 2008.
A. Belyaev, Y. Ohtake, "A comparison of mesh smoothing methods", Israel-Korea Bi-National Conference on Geometric
Modeling and Computer Graphics, 2003: normal smoothing and vertex fitting.
M. Kazhdan, H. Hoppe, "Screened Poisson surface reconstruction", ACM Transactions on Graphics 32, 2013.
M. Garland, P. Heckbert, "Surface simplification using quadric error metrics", SIGGRAPH, 1997.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.errors import StageError
from quadpatch.types import FloatArray, TriangleMesh, Triangles, Vertices


def two_step_smooth(mesh: TriangleMesh, n_iterations: int) -> TriangleMesh:
    """Smooth the normals, then fit the vertices to them; several times.

    One iteration smooths normals in 20 passes, over neighbours within 60 degrees, and fits vertices in 20 more, which
    are MeshLab's defaults. 30 iterations take about a minute for 64,000 vertices.

    Parameters
    ----------
    mesh : TriangleMesh
    n_iterations : int

    Returns
    -------
    TriangleMesh
        New vertices, the very same triangles. Vertices that no triangle uses stay where they are.

    Raises
    ------
    StageError
        If MeshLab refuses the mesh.
    """
    if not len(mesh.triangles):
        return mesh
    # The filter drops vertices without a triangle, and then loses count of the others.
    used, compact = np.unique(mesh.triangles, return_inverse=True)
    used_alone = TriangleMesh(mesh.vertices[used], compact.reshape(-1, 3))
    vertices = mesh.vertices.copy()
    vertices[used], _ = _filtered(used_alone, "apply_coord_two_steps_smoothing", stepsmoothnum=n_iterations)
    return TriangleMesh(vertices, mesh.triangles)


def close_holes(mesh: TriangleMesh, max_edges: int, edge_length: float) -> TriangleMesh:
    """Close all holes, and refine what closes them to edges of one length.

    Parameters
    ----------
    mesh : TriangleMesh
        Without vertices that no triangle uses.
    max_edges : int
        Longer loops stay open.
    edge_length : float
        In mesh units.

    Returns
    -------
    TriangleMesh
        Vertices and triangles of the input are its bit-exact prefix.

    Raises
    ------
    StageError
        If MeshLab refuses the mesh.
    """
    vertices, triangles = _filtered(
        mesh,
        "meshing_close_holes",
        maxholesize=max_edges + 1,  # it closes loops that are shorter than this
        newfaceselected=True,  # what is refined is what is selected
        selfintersection=False,  # its test leaves holes open that are no harm
        refinehole=True,
        refineholeedgelen=_library().PureValue(edge_length),
    )
    return TriangleMesh(vertices, triangles)


def poisson_surface(points: Vertices, normals: FloatArray, depth: int = 8) -> TriangleMesh:
    """Reconstruct a closed surface from oriented points.

    Parameters
    ----------
    points, normals : (n, 3) float64
        Normals look outwards; of unit length.
    depth : int
        Of the octree: the surface has cells of about 1.1 / 2 ** depth of the longest side of the points' box.

    Raises
    ------
    StageError
        If MeshLab finds no surface.
    """
    cloud = {"vertex_matrix": points, "v_normals_matrix": normals}
    return TriangleMesh(*_filtered(cloud, "generate_surface_reconstruction_screened_poisson", depth=depth, threads=1))


@dataclass(frozen=True)
class CollapseOptions:
    """How edges are collapsed.

    Attributes
    ----------
    quality : float
        0 to 1: how much triangles of a poor shape cost.
    border_weight : float
        Of the border against the surface.
    keeps_topology : bool
        Whether collapses that close a handle or a hole are left out.
    keeps_border : bool
        Whether vertices on the border stay where they are.
    """

    quality: float = 0.3
    border_weight: float = 1.0
    keeps_topology: bool = False
    keeps_border: bool = False


def collapse_edges(mesh: TriangleMesh, n_triangles: int, options: CollapseOptions | None = None) -> TriangleMesh:
    """Simplify a mesh to about so many triangles by collapsing the edges of least quadric error.

    Raises
    ------
    StageError
        If MeshLab refuses the mesh.
    """
    options = options or CollapseOptions()
    vertices, triangles = _filtered(
        mesh,
        "meshing_decimation_quadric_edge_collapse",
        targetfacenum=n_triangles,
        qualitythr=options.quality,
        boundaryweight=options.border_weight,
        preservenormal=True,
        preservetopology=options.keeps_topology,
        preserveboundary=options.keeps_border,
    )
    return TriangleMesh(vertices, triangles)


def split_edges(mesh: TriangleMesh, edge_length: float) -> TriangleMesh:
    """Split all edges longer than a length (mesh units) at their midpoints, until none is left.

    Raises
    ------
    StageError
        If MeshLab refuses the mesh.
    """
    longest = _longest_edge(mesh)
    n_rounds = max(0, int(np.ceil(np.log2(longest / edge_length)))) if longest else 0
    if not n_rounds:
        return mesh
    threshold = _library().PureValue(edge_length)
    return TriangleMesh(
        *_filtered(mesh, "meshing_surface_subdivision_midpoint", iterations=n_rounds, threshold=threshold)
    )


def write_ply(mesh: TriangleMesh, path: Path) -> None:
    """Write a mesh as binary PLY with coordinates in double precision.

    Raises
    ------
    StageError
        If the file can't be written.
    """
    library = _library()
    meshes = library.MeshSet(verbose=False)
    meshes.add_mesh(library.Mesh(mesh.vertices, mesh.triangles))
    plain = dict.fromkeys(
        ("save_vertex_quality", "save_vertex_color", "save_vertex_normal", "save_face_color", "save_wedge_texcoord"),
        False,
    )
    try:
        meshes.save_current_mesh(str(path), binary=True, **plain)
    except library.PyMeshLabException as error:
        raise StageError(f"MeshLab can't write {path.name}: {error}") from error


def _longest_edge(mesh: TriangleMesh) -> float:
    corners = mesh.vertices[mesh.triangles]
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(initial=0.0))


def _filtered(mesh: TriangleMesh | dict[str, FloatArray], name: str, **parameters: Any) -> tuple[Vertices, Triangles]:
    """Apply one filter to a copy of a mesh, or of arrays by their names; return vertices and triangles."""
    library = _library()
    arrays = {"vertex_matrix": mesh.vertices, "face_matrix": mesh.triangles} if isinstance(mesh, TriangleMesh) else mesh
    meshes = library.MeshSet(verbose=False)
    try:
        meshes.add_mesh(library.Mesh(**arrays))
        meshes.apply_filter(name, **parameters)
    except library.PyMeshLabException as error:
        raise StageError(f"MeshLab's {name}: {error}") from error
    made = meshes.current_mesh()
    return np.array(made.vertex_matrix(), np.float64), np.array(made.face_matrix(), np.int64).reshape(-1, 3)


def _library() -> Any:
    import pymeshlab  # noqa: PLC0415  see the module docstring

    return pymeshlab
