"""A mesh whose holes are closed: measured surface first, unchanged, invented surface behind it."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices


class JoinedMesh(TriangleMesh):
    """A mesh with invented surface behind it, put together once its arrays are asked for: a large one seldom is.

    Parameters
    ----------
    measured : TriangleMesh
    new_vertices : (k, 3) float64
    new_triangles : (l, 3) int64
        Into the vertices of the mesh, followed by the new ones.
    """

    def __init__(self, measured: TriangleMesh, new_vertices: Vertices, new_triangles: Triangles) -> None:
        # The arrays of the base class are made below.
        self.__dict__.update(measured=measured, new_vertices=new_vertices, new_triangles=new_triangles)

    measured: TriangleMesh
    new_vertices: Vertices
    new_triangles: Triangles

    @cached_property
    def vertices(self) -> Vertices:
        """All vertices."""
        return np.concatenate([self.measured.vertices, self.new_vertices])

    @cached_property
    def triangles(self) -> Triangles:
        """All triangles."""
        return np.concatenate([self.measured.triangles, self.new_triangles])


@dataclass(frozen=True)
class FilledMesh:
    """A mesh with its holes closed: measured vertices and triangles first, unchanged, invented ones behind them.

    Attributes
    ----------
    mesh : TriangleMesh
    n_measured_vertices, n_measured_triangles : int
    triangle_hole : (n_invented_triangles,) int64
        Position in the list of loops of every invented triangle's hole.
    vertex_hole : (n_invented_vertices,) int64
    disagreement, rim_variation : (n_loops,) float64
        See `quadpatch.filling.fill.ClosedMesh`.
    unfilled : list of int
        Positions of loops that could not be closed without giving an edge a third face.
    energy_weights : (n_loops, n_energies) float64, optional
        Shares of fairing energies in the fills, see `quadpatch.calibration.energy_selection`.
    """

    mesh: TriangleMesh
    n_measured_vertices: int
    n_measured_triangles: int
    triangle_hole: IntArray
    vertex_hole: IntArray
    disagreement: FloatArray
    rim_variation: FloatArray
    unfilled: list[int]
    energy_weights: FloatArray | None = None

    @property
    def measured(self) -> TriangleMesh:
        """The mesh that was filled."""
        if isinstance(self.mesh, JoinedMesh):
            return self.mesh.measured
        return TriangleMesh(
            self.mesh.vertices[: self.n_measured_vertices], self.mesh.triangles[: self.n_measured_triangles]
        )

    @property
    def new_vertices(self) -> Vertices:
        """Invented vertices, (n_invented_vertices, 3)."""
        if isinstance(self.mesh, JoinedMesh):
            return self.mesh.new_vertices
        return self.mesh.vertices[self.n_measured_vertices :]

    @property
    def new_triangles(self) -> Triangles:
        """Invented triangles, (n_invented_triangles, 3)."""
        if isinstance(self.mesh, JoinedMesh):
            return self.mesh.new_triangles
        return self.mesh.triangles[self.n_measured_triangles :]

    @property
    def invented_triangles(self) -> BoolArray:
        """(n_triangles,) bool, True = invented."""
        return np.arange(len(self.mesh.triangles)) >= self.n_measured_triangles

    @property
    def invented_vertices(self) -> BoolArray:
        """(n_vertices,) bool, True = invented."""
        return np.arange(len(self.mesh.vertices)) >= self.n_measured_vertices

    def with_vertices(self, invented: FloatArray) -> "FilledMesh":
        """Return the same mesh with other positions (n_invented_vertices, 3) of the invented vertices."""
        vertices = np.concatenate([self.mesh.vertices[: self.n_measured_vertices], invented])
        return replace(self, mesh=TriangleMesh(vertices, self.mesh.triangles))

    def displaced(self, displacement: FloatArray) -> "FilledMesh":
        """Return the same mesh with its invented vertices moved by (n_invented_vertices, 3)."""
        return self.with_vertices(self.mesh.vertices[self.n_measured_vertices :] + displacement)

    def without(self, loops: IntArray) -> "FilledMesh":
        """Return the mesh with some loops (k,) open again."""
        new_vertices = self.mesh.vertices[self.n_measured_vertices :]
        keep_vertex, keep = ~np.isin(self.vertex_hole, loops), ~np.isin(self.triangle_hole, loops)
        to_kept = np.arange(len(self.mesh.vertices))
        to_kept[self.n_measured_vertices :] = self.n_measured_vertices + np.cumsum(keep_vertex) - 1
        new = to_kept[self.mesh.triangles[self.n_measured_triangles :][keep]]
        mesh = TriangleMesh(
            np.concatenate([self.mesh.vertices[: self.n_measured_vertices], new_vertices[keep_vertex]]),
            np.concatenate([self.mesh.triangles[: self.n_measured_triangles], new]),
        )
        return replace(
            self, mesh=mesh, triangle_hole=self.triangle_hole[keep], vertex_hole=self.vertex_hole[keep_vertex]
        )

    def with_fills(self, other: "FilledMesh", loops: IntArray) -> "FilledMesh":
        """Take the fills of some loops (k,) from another fill of the same loops of the same mesh."""
        base = self.without(loops)
        replacement = other.without(np.setdiff1d(np.arange(len(self.disagreement)), loops))
        shift = len(base.mesh.vertices) - other.n_measured_vertices
        new = replacement.mesh.triangles[other.n_measured_triangles :]
        new = np.where(new >= other.n_measured_vertices, new + shift, new)
        mesh = TriangleMesh(
            np.concatenate([base.mesh.vertices, replacement.mesh.vertices[other.n_measured_vertices :]]),
            np.concatenate([base.mesh.triangles, new]),
        )
        return replace(
            base,
            mesh=mesh,
            triangle_hole=np.concatenate([base.triangle_hole, replacement.triangle_hole]),
            vertex_hole=np.concatenate([base.vertex_hole, replacement.vertex_hole]),
            unfilled=sorted(set(self.unfilled) - set(loops.tolist()) | set(other.unfilled) & set(loops.tolist())),
        )

    def as_part_of(self, loops: IntArray, whole: "FilledMesh") -> "FilledMesh":
        """Renumber the fill of some loops (k,) of a list, of which `whole` fills all."""
        return replace(
            self,
            triangle_hole=loops[self.triangle_hole],
            vertex_hole=loops[self.vertex_hole],
            disagreement=whole.disagreement,
            rim_variation=whole.rim_variation,
            energy_weights=whole.energy_weights,
            unfilled=loops[self.unfilled].tolist(),
        )


def rim_diagonals(
    vertices: FloatArray, triangles: IntArray, hole: IntArray, n_measured: int, n_holes: int
) -> FloatArray:
    """Measure the rims of fills by the diagonals of their bounding boxes.

    Parameters
    ----------
    vertices : (n, 3) float64
        Measured ones first.
    triangles : (m, 3) int64
        Of the fills.
    hole : (m,) int64
        Of every triangle.
    n_measured, n_holes : int

    Returns
    -------
    (n_holes,) float64
        In mesh units; 0 without a fill.
    """
    corners = triangles.ravel()
    of_corner = np.repeat(hole, 3)
    on_rim = corners < n_measured
    low, high = np.full((n_holes, 3), np.inf), np.full((n_holes, 3), -np.inf)
    np.minimum.at(low, of_corner[on_rim], vertices[corners[on_rim]])
    np.maximum.at(high, of_corner[on_rim], vertices[corners[on_rim]])
    size = np.where(np.isfinite(low), high, 0.0) - np.where(np.isfinite(low), low, 0.0)
    return np.asarray(np.linalg.norm(size, axis=1))
