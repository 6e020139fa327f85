"""Heights of a surface over the grid of a quad mesh.

From every grid vertex a ray runs both ways along the normal there, as in a height map; the nearer surface counts that
faces the normal. A grid vertex that sees none has no height of its own: codes go by the others.

A grid whose vertices lie on a bent surface runs inside it between them. So heights are moved afterwards, until the
surface's own vertices lie as far above as below the grid.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.compression.subdivision import Subdivision, grid_normals, subdivide
from quadpatch.compression.surface_fit import barycentric
from quadpatch.mesh.distance import project
from quadpatch.mesh.raycast import RayScene
from quadpatch.types import BoolArray, FloatArray, IntArray, QuadMesh, TriangleMesh, Triangles, Vertices

# Cosine between the normals of grid and surface, below which a surface does not count.
_LEAST_AGREEMENT = 0.2
# Share of the mean side of a quad within which a surface counts.
_REACH = 0.75
# A height that steps by more than this many lengths of a grid edge leaves one sheet of surface for another.
_STEEPEST = 3.0
_BALANCE_ROUNDS = 2
_MOST_SAMPLES = 200_000
# A balanced height moves at most by this share of a cell's side.
_MOST_BALANCE = 0.5


@dataclass(frozen=True)
class Grid:
    """Subdivision surface of a quad mesh, and what heights are measured along.

    Attributes
    ----------
    points, normals : (n, 3) float64
        Of every grid vertex; unit normals.
    patches : (n_quads, m + 1, m + 1) int64
        Grid vertices of each quad.
    triangles : (2 * n_quads * m * m, 3) int64
    """

    points: Vertices
    normals: FloatArray
    patches: IntArray
    triangles: Triangles

    @property
    def n_shared(self) -> FloatArray:
        """Patches that each grid vertex belongs to: (n,)."""
        return np.bincount(self.patches.ravel(), minlength=len(self.points)).astype(np.float64)

    def raised(self, heights: FloatArray) -> Vertices:
        """Move the grid vertices along their normals."""
        return self.points + heights[:, np.newaxis] * self.normals


def make_grid(quad_mesh: QuadMesh, levels: int) -> Grid:
    """Subdivide a quad mesh into a grid of 2**levels cells along each side."""
    fine: Subdivision = subdivide(quad_mesh.quads, len(quad_mesh.vertices), levels)
    points = np.asarray(fine.matrix @ quad_mesh.vertices)
    return Grid(points, grid_normals(points, fine.cells), fine.grid, fine.triangles)


def measure_heights(grid: Grid, surface: TriangleMesh, scene: RayScene, side: float) -> tuple[FloatArray, BoolArray]:
    """Measure the height of a surface over every grid vertex.

    Parameters
    ----------
    grid : Grid
    surface : TriangleMesh
    scene : RayScene
        Of that surface.
    side : float
        Mean side of a quad, in mesh units.

    Returns
    -------
    heights : (n,) float64
        0 where none is known.
    known : (n,) bool
    """
    facing = _unit_triangle_normals(surface)
    ways = [_seen(grid, scene, facing, way * side * _REACH) for way in (1.0, -1.0)]
    nearer = np.where(np.abs(ways[0]) <= np.abs(ways[1]), ways[0], ways[1])
    known = np.isfinite(nearer)
    nearer[~known] = 0.0
    known &= ~_is_at_step(grid, nearer, known)
    return _balanced(grid, surface, np.where(known, nearer, 0.0), known), known


def _seen(grid: Grid, scene: RayScene, facing: FloatArray, reach: float) -> FloatArray:
    """Signed distance to the first surface one way; infinite where it faces elsewhere or is out of reach."""
    way = np.sign(reach)
    triangle, distance = scene.cast(grid.points, way * grid.normals, abs(reach))
    agrees = np.einsum("ij,ij->i", facing[triangle], grid.normals) > _LEAST_AGREEMENT
    return np.where((triangle >= 0) & agrees & (distance <= abs(reach)), way * distance, np.inf)


def _is_at_step(grid: Grid, heights: FloatArray, known: BoolArray) -> BoolArray:
    """Grid vertices at an edge over which the height steps: the surface is folded there, and no height map."""
    one, other = grid.triangles.ravel(), np.roll(grid.triangles, -1, axis=1).ravel()
    length = np.linalg.norm(grid.points[one] - grid.points[other], axis=1)
    steps = known[one] & known[other] & (np.abs(heights[one] - heights[other]) > _STEEPEST * length)
    is_at_step = np.zeros(len(heights), bool)
    is_at_step[one[steps]] = is_at_step[other[steps]] = True
    return is_at_step


def _balanced(grid: Grid, surface: TriangleMesh, heights: FloatArray, known: BoolArray) -> FloatArray:
    """Move heights by the mean of how far the surface's vertices lie above the grid around."""
    used = np.unique(surface.triangles)
    samples = surface.vertices[used[:: 1 + len(used) // _MOST_SAMPLES]]
    edge = np.linalg.norm(grid.points[grid.triangles[:, 0]] - grid.points[grid.triangles[:, 1]], axis=1)
    limit = _MOST_BALANCE * float(edge.mean())
    for _ in range(_BALANCE_ROUNDS):
        mesh = TriangleMesh(grid.raised(heights), grid.triangles)
        distance, triangle, places = project(samples, mesh)
        near = distance < limit
        corners = grid.triangles[triangle[near]]
        weights = barycentric(places[near], mesh.vertices[corners])
        normals = np.einsum("ij,ijk->ik", weights, grid.normals[corners])
        above = np.einsum("ij,ij->i", samples[near] - places[near], normals)
        total = np.bincount(corners.ravel(), weights.ravel(), len(heights))
        pull = np.bincount(corners.ravel(), (weights * above[:, np.newaxis]).ravel(), len(heights))
        mean = np.divide(pull, total, out=np.zeros_like(pull), where=total > 0)
        heights = np.where(known, heights + np.clip(mean, -limit, limit), 0.0)
    return heights


def _unit_triangle_normals(mesh: TriangleMesh) -> FloatArray:
    a, b, c = (mesh.vertices[mesh.triangles[:, corner]] for corner in range(3))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.asarray(np.divide(normal, length, out=np.zeros_like(normal), where=length > 0))
