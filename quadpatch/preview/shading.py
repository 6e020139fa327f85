"""Draw one view of a mesh: matte grey clay under two lights."""

from copy import copy

import numpy as np

from quadpatch.mesh.normals import triangle_normals, unit
from quadpatch.mesh.raycast import Hits, Places, RayScene
from quadpatch.mesh.topology import compacted
from quadpatch.mesh.weld import weld
from quadpatch.preview.camera import Camera, View
from quadpatch.preview.facets import Facets
from quadpatch.preview.parts import touching
from quadpatch.preview.sampling import Colours, sampled
from quadpatch.types import BoolArray, FloatArray, TriangleMesh

BACKGROUND = np.array([0.965, 0.968, 0.972])
CLAY = np.array([0.80, 0.79, 0.77])
# The inside of the surface, seen through a hole.
BACK = np.array([0.30, 0.34, 0.42])

# Lights in the camera's axes (right, up, towards) with their strength: a key from the upper left, a weak fill from
# the right that keeps the shadows open, and light from everywhere.
_LIGHTS = (((-0.45, 0.60, 0.66), 0.76), ((0.70, -0.35, 0.62), 0.30))
_AMBIENT = 0.24
_TINY = np.finfo(np.float32).tiny


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
        self._left_out: BoolArray | None = None
        self._flat = triangle_normals(mesh.vertices, mesh.triangles)
        if is_joined:
            self._smooth = _smooth_normals(mesh, self._flat)
        else:
            welded = weld(mesh.vertices, mesh.triangles)
            flat = triangle_normals(welded.mesh.vertices, welded.mesh.triangles)
            self._smooth = _smooth_normals(welded.mesh, flat)[welded.from_file]

    def without(self, left_out: BoolArray) -> "Clay":
        """Leave out some triangles (n_triangles,) of a mesh whose triangles share their vertices."""
        other = copy(self)
        other._left_out = left_out
        # Without them, the normals of their neighbours at the vertices between them are others.
        stays = touching(self._mesh, left_out) & ~left_out
        near = TriangleMesh(self._mesh.vertices, self._mesh.triangles[stays])
        other._smooth = self._smooth.copy()
        shared = self._mesh.triangles[left_out]
        other._smooth[shared] = _smooth_normals(near, self._flat[stays])[shared]
        return other

    def draw(self, camera: Camera, size: tuple[int, int]) -> FloatArray:
        """Draw a picture (rows, columns, 3) of `size` (columns, rows), in pixels: red, green, blue, 0..1."""
        view = View(camera, size)
        colours = sampled(lambda places: self.shaded(view, places, self.seen_at(view, places))[None], size)
        return np.asarray(colours[0], dtype=np.float64)

    def seen_at(self, view: View, places: Places) -> Hits:
        """Triangles (n,) that are seen at places (2, n); -1 for none."""
        return self._scene.seen_in(view.plane, -view.camera.towards, places, self._left_out)

    def shaded(self, view: View, places: Places, triangle: Hits) -> Colours:
        """Colours (3, n) of triangles (n,) at places (2, n); the background for the triangle -1."""
        colours = np.repeat(BACKGROUND.astype(np.float32)[:, None], len(triangle), axis=1)
        hit = np.flatnonzero(triangle >= 0)
        seen, facet = compacted(triangle[hit].astype(np.int64), len(self._mesh.triangles))
        facets = Facets(self._mesh, self._flat, self._smooth, seen, view)
        base = np.where(facets.is_front, self._colours[seen].T, BACK[:, None]).astype(np.float32)
        light = _light(facets.normals_at(facet, places[:, hit]))
        for channel in range(3):
            colours[channel, hit] = np.minimum(base[channel, facet] * light, 1)
        return colours


def _light(normals: Colours) -> Colours:
    """Light (n,) on surfaces by their normals (3, n) in the camera's axes, of any length."""
    x, y, z = normals
    scale = 1 / np.sqrt(np.maximum(x * x + y * y + z * z, _TINY))
    light: Colours = np.full_like(scale, _AMBIENT)
    for direction, strength in _LIGHTS:
        right, up, towards = (strength / np.linalg.norm(direction) * np.array(direction)).astype(np.float32)
        light += np.maximum(right * x + up * y + towards * z, 0) * scale
    return light


def _smooth_normals(mesh: TriangleMesh, flat: FloatArray) -> FloatArray:
    """Mean normal (n_vertices, 3) of the triangles around each vertex, weighted by their angle there.

    The angle, unlike the area, does not depend on how a flat side was cut into triangles, so that an edge between
    two flat sides is recognised as sharp from both.
    """
    corners = mesh.triangles.T
    sides = [unit(mesh.vertices[corners[(k + 1) % 3]] - mesh.vertices[corners[k]]) for k in range(3)]
    total = np.zeros_like(mesh.vertices)
    for k in range(3):
        cosine = -np.einsum("ij,ij->i", sides[k], sides[k - 1])
        vectors = np.arccos(np.clip(cosine, -1.0, 1.0))[:, None] * flat
        for axis in range(3):
            total[:, axis] += np.bincount(corners[k], vectors[:, axis], minlength=len(total))
    return unit(total)
