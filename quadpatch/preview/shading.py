"""Draw one view of a mesh: matte grey clay under two lights."""

import numpy as np

from quadpatch.mesh.normals import triangle_normals, unit
from quadpatch.mesh.raycast import RayScene
from quadpatch.mesh.weld import weld
from quadpatch.preview.camera import Camera
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Vertices

BACKGROUND = np.array([0.965, 0.968, 0.972])
CLAY = np.array([0.80, 0.79, 0.77])
# The inside of the surface, seen through a hole.
BACK = np.array([0.30, 0.34, 0.42])

# Lights in the camera's axes (right, up, towards) with their strength: a key from the upper left, a weak fill from
# the right that keeps the shadows open, and light from everywhere.
_LIGHTS = (((-0.45, 0.60, 0.66), 0.76), ((0.70, -0.35, 0.62), 0.30))
_AMBIENT = 0.24
# Corners whose normal is farther than about 28 degrees from their triangle's belong to a sharp edge.
_SHARP = 0.88
# Pixels that differ from a neighbour by more than this (of 1) get more rays.
_EDGE = 0.04
# Places of the rays within such a pixel: a rotated square, which has no two on one row or column.
_SUBPIXELS = ((0.375, 0.125), (0.875, 0.375), (0.125, 0.625), (0.625, 0.875))
_CHUNK = 60_000


class Clay:
    """A mesh, ready to be drawn from any side.

    Parameters
    ----------
    mesh : TriangleMesh
        Repeated vertices are shaded as one.
    scene : RayScene
        Of `mesh`, or of the same triangles turned over.
    colours : (n_triangles, 3) float64
        Red, green, blue of the outside of each triangle, 0..1.
    is_joined : bool
        Whether triangles that touch share their vertices already.
    """

    def __init__(self, mesh: TriangleMesh, scene: RayScene, colours: FloatArray, *, is_joined: bool = False) -> None:
        self._scene = scene
        self._mesh = mesh
        self._colours = colours
        self._flat = triangle_normals(mesh.vertices, mesh.triangles)
        if is_joined:
            self._smooth = _smooth_normals(mesh)
        else:
            welded = weld(mesh.vertices, mesh.triangles)
            self._smooth = _smooth_normals(welded.mesh)[welded.from_file]

    def draw(self, camera: Camera, size: tuple[int, int]) -> FloatArray:
        """Draw a picture.

        One ray goes through the middle of each pixel, four more through those that differ from a neighbour.

        Parameters
        ----------
        camera : Camera
        size : (int, int)
            Columns and rows, in pixels.

        Returns
        -------
        (rows, columns, 3) float64
            Red, green, blue, 0..1.
        """
        rows, columns = (grid.ravel().astype(np.float64) for grid in np.indices((size[1], size[0])))
        picture = self._colours_at(camera, columns + 0.5, rows + 0.5, size)
        edge = np.flatnonzero(_differs_from_neighbours(picture.reshape(size[1], size[0], 3)))
        samples = [
            self._colours_at(camera, columns[edge] + right, rows[edge] + down, size) for right, down in _SUBPIXELS
        ]
        picture[edge] = np.mean(samples, axis=0)
        return picture.reshape(size[1], size[0], 3)

    def _colours_at(self, camera: Camera, columns: FloatArray, rows: FloatArray, size: tuple[int, int]) -> FloatArray:
        colours = np.tile(BACKGROUND, (len(columns), 1))
        # Loop over chunks, which bound the memory.
        for start in range(0, len(columns), _CHUNK):
            chunk = slice(start, start + _CHUNK)
            origins = camera.ray_origins(columns[chunk], rows[chunk], size)
            triangle, distance = self._scene.cast(origins, np.broadcast_to(-camera.towards, origins.shape))
            hit = np.flatnonzero(triangle >= 0)
            points = origins[hit] - distance[hit, None] * camera.towards
            colours[start + hit] = self._shaded(camera, triangle[hit], points)
        return colours

    def _shaded(self, camera: Camera, triangle: IntArray, points: Vertices) -> FloatArray:
        is_front = self._flat[triangle] @ camera.towards > 0
        normals = self._normals_at(triangle, points) * np.where(is_front, 1.0, -1.0)[:, None]
        local = normals @ np.stack([camera.right, camera.up, camera.towards]).T
        light = np.full(len(points), _AMBIENT)
        for direction, strength in _LIGHTS:
            light += strength * np.maximum(local @ (np.array(direction) / np.linalg.norm(direction)), 0.0)
        base = np.where(is_front[:, None], self._colours[triangle], BACK)
        shaded: FloatArray = np.clip(base * light[:, None], 0.0, 1.0)
        return shaded

    def _normals_at(self, triangle: IntArray, points: Vertices) -> FloatArray:
        """Interpolate the normals of the corners; take the triangle's own at the corners of sharp edges."""
        corners = self._mesh.triangles[triangle]
        flat = self._flat[triangle]
        weights = _barycentric(points, *(self._mesh.vertices[corners[:, k]] for k in range(3)))
        total = np.zeros_like(points)
        for k in range(3):
            smooth = self._smooth[corners[:, k]]
            is_sharp = np.einsum("ij,ij->i", smooth, flat) < _SHARP
            total += weights[:, k, None] * np.where(is_sharp[:, None], flat, smooth)
        length = np.linalg.norm(total, axis=1, keepdims=True)
        normals: FloatArray = np.divide(total, length, out=flat.copy(), where=length > 0)
        return normals


def _smooth_normals(mesh: TriangleMesh) -> FloatArray:
    """Mean normal (n_vertices, 3) of the triangles around each vertex, weighted by their angle there.

    The angle, unlike the area, does not depend on how a flat side was cut into triangles, so that an edge between
    two flat sides is recognised as sharp from both.
    """
    flat = triangle_normals(mesh.vertices, mesh.triangles)
    total = np.zeros_like(mesh.vertices)
    for k in range(3):
        here, after, before = (mesh.vertices[mesh.triangles[:, (k + step) % 3]] for step in range(3))
        cosine = np.einsum("ij,ij->i", unit(after - here), unit(before - here))
        vectors = np.arccos(np.clip(cosine, -1.0, 1.0))[:, None] * flat
        for axis in range(3):
            total[:, axis] += np.bincount(mesh.triangles[:, k], vectors[:, axis], minlength=len(total))
    return unit(total)


def _barycentric(points: Vertices, a: Vertices, b: Vertices, c: Vertices) -> FloatArray:
    """Weights (n, 3) of the corners for points in the planes of triangles; equal where a triangle has no area."""
    u, v, w = b - a, c - a, points - a
    uu, uv, vv, uw, vw = (np.einsum("ij,ij->i", one, other) for one, other in ((u, u), (u, v), (v, v), (u, w), (v, w)))
    square = uu * vv - uv**2
    none = np.full(len(points), 1 / 3)
    of_b = np.divide(vv * uw - uv * vw, square, out=none.copy(), where=square > 0)
    of_c = np.divide(uu * vw - uv * uw, square, out=none, where=square > 0)
    return np.stack([1 - of_b - of_c, of_b, of_c], axis=1)


def _differs_from_neighbours(picture: FloatArray) -> BoolArray:
    """Tell pixels (rows, columns) of which some colour is not that of the next one in the row or column."""
    differs = np.zeros(picture.shape[:2], dtype=bool)
    for channel in np.moveaxis(picture, 2, 0):
        across = np.abs(np.diff(channel, axis=1)) > _EDGE
        along = np.abs(np.diff(channel, axis=0)) > _EDGE
        differs[:, 1:] |= across
        differs[:, :-1] |= across
        differs[1:] |= along
        differs[:-1] |= along
    return differs
