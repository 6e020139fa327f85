"""Normals of the triangles that a picture shows.

Seen by an orthographic camera, what is interpolated between the corners of a triangle is linear in column and row: it
takes three vectors for each triangle, and no points on it.

Tested in `tests/quadpatch/preview/test_shading.py`.
"""

import numpy as np

from quadpatch.mesh.raycast import Places
from quadpatch.preview.camera import View
from quadpatch.preview.sampling import Colours
from quadpatch.types import FloatArray, IntArray, TriangleMesh

# Corners whose normal is farther than about 28 degrees from their triangle's belong to a sharp edge.
_SHARP = 0.88
# Triangles that cover less than half of this, in square pixels, have one normal: across them it would change faster
# than float32 tells places apart.
_LEAST_AREA = 0.5


class Facets:
    """Some triangles of a mesh in a view.

    Parameters
    ----------
    mesh : TriangleMesh
    flat, smooth : (n_triangles, 3), (n_vertices, 3) float64
        Unit normals of the triangles and around the vertices; at corners of sharp edges the triangle's own is taken.
    chosen : (k,) int64
        Triangles.
    view : View
    """

    def __init__(self, mesh: TriangleMesh, flat: FloatArray, smooth: FloatArray, chosen: IntArray, view: View) -> None:
        corners = mesh.triangles[chosen].T
        own = flat[chosen]
        self.is_front = own @ view.camera.towards > 0
        normals = [view.camera.axes @ _at_corner(own, smooth[corner]).T for corner in corners]
        columns, rows = (place.reshape(3, -1) for place in view.places(mesh.vertices[corners.ravel()]))
        per_column, per_row = _slopes(columns, rows, normals)
        self._middle = view.size[0] / 2, view.size[1] / 2
        from_middle = columns.mean(axis=0) - self._middle[0], rows.mean(axis=0) - self._middle[1]
        in_middle = sum(normals) / 3 - from_middle[0] * per_column - from_middle[1] * per_row
        side = np.where(self.is_front, 1.0, -1.0)
        self._planes = (side * np.stack([in_middle, per_column, per_row], axis=1)).astype(np.float32)

    def normals_at(self, facet: IntArray, places: Places) -> Colours:
        """Interpolate normals, which need not be of unit length.

        Parameters
        ----------
        facet : (n,) int64
            Positions in `chosen`.
        places : (2, n) float32
            Columns and rows.

        Returns
        -------
        (3, n) float32
            Along the camera's right, up and towards; of the side that is seen.
        """
        column, row = (place - np.float32(middle) for place, middle in zip(places, self._middle, strict=True))
        return np.stack(
            [first[facet] + column * second[facet] + row * third[facet] for first, second, third in self._planes]
        )


def _at_corner(own: FloatArray, smooth: FloatArray) -> FloatArray:
    is_sharp = np.einsum("ij,ij->i", own, smooth) < _SHARP
    return np.where(is_sharp[:, None], own, smooth)


def _slopes(columns: FloatArray, rows: FloatArray, normals: list[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Change (3, k) of normals per column and per row, from those (3, k) at corners in columns and rows (3, k)."""
    right, down = columns[1:] - columns[0], rows[1:] - rows[0]
    area = right[0] * down[1] - right[1] * down[0]
    scale = np.divide(1.0, area, out=np.zeros_like(area), where=np.abs(area) > _LEAST_AREA)
    one, two = (normals[1] - normals[0]) * scale, (normals[2] - normals[0]) * scale
    return down[1] * one - down[0] * two, right[0] * two - right[1] * one
