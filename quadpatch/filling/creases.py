"""Creases of a fill: where surfaces meet at an angle, fairing rounds what should be an edge.

The normals of new triangles are filtered so that those of one face of the object become equal and those of two faces
stay apart; then the new vertices are moved until the triangles have these normals. Normals of the measured triangles
around the rim are known, and stay as they are: the faces of the object grow from the rim inwards until they meet.

References
----------
X. Sun, P. L. Rosin, R. R. Martin, F. C. Langbein, "Fast and effective feature-preserving mesh denoising", IEEE
Transactions on Visualization and Computer Graphics 13, 2007: the movement of the vertices.
Y. Zheng, H. Fu, O. K.-C. Au, C.-L. Tai, "Bilateral normal filtering for mesh denoising", IEEE Transactions on
Visualization and Computer Graphics 17, 2011: the weights of the normals.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse

from quadpatch.filling.fairing import triangles_around
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.normals import area_vectors, length, triangle_normals, unit
from quadpatch.mesh.topology import neighbouring_triangles
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# Two neighbours that turn by more lie on two sides of a crease.
CREASE_ANGLE_DEG = 40.0
# Normals that differ by this length are alike by exp(-1/2).
_DEVIATION = 0.2
# Triangles around a vertex with more of them are neighbours by their other vertices only.
_CROWDED = 40
# Rings of measured triangles whose normals are looked at.
_RINGS = 3
# Rounds of filtering and moving, and the steps of each; weights of normals are renewed every few steps.
ROUNDS = 10
_NORMAL_STEPS = 30
_STEPS_PER_WEIGHT = 10
_VERTEX_STEPS = 30
# Of the vertex steps of a round the first few also even out the triangles.
_EVEN_STEPS = 3
_EVEN_SHARE = 0.5
# Directions in which the normals around a vertex have less than this share of their largest sum of squares are free:
# it moves along them without leaving the faces it lies on.
_FREE_SHARE = 0.02


def crease_share(mesh: TriangleMesh) -> float:
    """Measure which share of the edges between two triangles are creases."""
    pairs, _ = neighbouring_triangles(mesh.triangles)
    if not len(pairs):
        return 0.0
    normals = triangle_normals(mesh.vertices, mesh.triangles)
    cosines = np.einsum("ij,ij->i", normals[pairs[:, 0]], normals[pairs[:, 1]])
    return float((cosines < np.cos(np.radians(CREASE_ANGLE_DEG))).mean())


def crease_displacement(filled: FilledMesh, rounds: int = ROUNDS) -> FloatArray:
    """Work out how far to move the new vertices so that the faces of the object around the holes meet in creases.

    Parameters
    ----------
    filled : FilledMesh
        With faired fills.
    rounds : int
        Of filtering and moving; the first few go a good part of the way.

    Returns
    -------
    (n_invented_vertices, 3) float64
        In mesh units. The result may fold or cross other surface: check it.
    """
    new = np.arange(filled.n_measured_vertices, len(filled.mesh.vertices))
    if not len(new):
        return np.zeros((0, 3))
    surroundings = _Surroundings.of(filled)
    vertices = surroundings.vertices.copy()
    normals = triangle_normals(vertices, surroundings.triangles)
    for _ in range(rounds):
        surroundings.filter_normals(vertices, normals)
        surroundings.fit_vertices(vertices, normals)
    moved = np.zeros((len(new), 3))
    moved[surroundings.origin[surroundings.new_vertices] - new[0]] = (
        vertices[surroundings.new_vertices] - surroundings.vertices[surroundings.new_vertices]
    )
    return moved


@dataclass(frozen=True)
class _Surroundings:
    """New triangles and the measured ones around them, in vertices of their own.

    Attributes
    ----------
    vertices : (n, 3) float64
    triangles : (m, 3) int64
    origin : (n,) int64
        Vertices of the filled mesh.
    new_vertices : (k,) int64
    new_triangles : (l,) int64
    at_vertex : (k, m) sparse float64
        1 where a triangle has a new vertex.
    beside : (l, m) sparse float64
        Not 0 where a triangle shares a vertex with a new one.
    around : (k, n) sparse float64
        Rows average over the vertices around a new one.
    """

    vertices: Vertices
    triangles: Triangles
    origin: IntArray
    new_vertices: IntArray
    new_triangles: IntArray
    at_vertex: "scipy.sparse.csr_array[np.float64]"
    beside: "scipy.sparse.csr_array[np.float64]"
    around: "scipy.sparse.csr_array[np.float64]"

    @classmethod
    def of(cls, filled: FilledMesh) -> "_Surroundings":
        """Take the fills and a few rings around them."""
        mesh = filled.mesh
        invented = mesh.triangles[filled.n_measured_triangles :].ravel()
        chosen = triangles_around(mesh.triangles, invented, len(mesh.vertices), _RINGS)
        origin, local = np.unique(mesh.triangles[chosen], return_inverse=True)
        triangles = local.reshape(-1, 3)
        new_vertices = np.flatnonzero(origin >= filled.n_measured_vertices)
        new_triangles = np.flatnonzero(chosen >= filled.n_measured_triangles)
        rows = np.repeat(np.arange(len(triangles)), 3)
        has = scipy.sparse.csr_array((np.ones(len(rows)), (rows, triangles.ravel())), (len(triangles), len(origin)))
        at_vertex = has.T.tocsr()[new_vertices]
        around = (at_vertex @ has).tocsr()
        around.data[around.indices == np.repeat(new_vertices, np.diff(around.indptr))] = 0.0
        around.data[around.data > 0] = 1.0
        around = scipy.sparse.csr_array(scipy.sparse.diags_array(1.0 / around.sum(axis=1)) @ around)
        # The triangles of a crowded vertex are not neighbours by it: their pairs would not fit in memory.
        plain = has @ scipy.sparse.diags_array((has.sum(axis=0) <= _CROWDED).astype(np.float64))
        itself = scipy.sparse.eye_array(len(triangles), format="csr")[new_triangles]
        beside = scipy.sparse.csr_array(plain[new_triangles] @ plain.T + itself)
        return cls(mesh.vertices[origin], triangles, origin, new_vertices, new_triangles, at_vertex, beside, around)

    def filter_normals(self, vertices: Vertices, normals: FloatArray) -> None:
        """Average the normals (m, 3) of new triangles over those beside them that are alike, by area; in place."""
        vectors = area_vectors(vertices, self.triangles)
        areas, new = length(vectors), self.new_triangles
        normals[new] = unit(vectors[new])
        row, beside = np.repeat(new, np.diff(self.beside.indptr)), self.beside.copy()
        for step in range(_NORMAL_STEPS):
            if step % _STEPS_PER_WEIGHT == 0:
                difference = normals[row] - normals[beside.indices]
                alike = np.exp(-np.einsum("ij,ij->i", difference, difference) / (2 * _DEVIATION**2))
                beside.data = areas[beside.indices] * alike
            normals[new] = unit(np.asarray(beside @ normals))

    def fit_vertices(self, vertices: Vertices, normals: FloatArray) -> None:
        """Move the new vertices until the triangles have these normals (m, 3), and are of about one size; in place."""
        squares = np.einsum("ti,tj->tij", normals, normals).reshape(-1, 9)
        squares = (self.at_vertex @ squares).reshape(-1, 3, 3)
        strength, direction = np.linalg.eigh(squares)
        is_free = strength < _FREE_SHARE * strength[:, 2:]
        free = np.einsum("vik,vk,vjk->vij", direction, is_free.astype(np.float64), direction)
        new, count = self.new_vertices, np.diff(self.at_vertex.indptr)[:, None]
        for step in range(_VERTEX_STEPS):
            centroids = vertices[self.triangles].mean(axis=1)
            heights = np.einsum("ij,ij->i", normals, centroids)[:, None]
            wanted = self.at_vertex @ (heights * normals)
            vertices[new] += (wanted - np.einsum("vij,vj->vi", squares, vertices[new])) / count
            if step < _EVEN_STEPS:
                off_centre = self.around @ vertices - vertices[new]
                vertices[new] += _EVEN_SHARE * np.einsum("vij,vj->vi", free, off_centre)
