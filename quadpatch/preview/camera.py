"""Orthographic cameras.

A camera looks along ``-towards`` at `centre`; `right` and `up` span its picture. Its rays start on a plane in front
of `centre`, so that a close-up looks past whatever stands farther in front.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.types import FloatArray, Vertices

# Scans mostly stand along y; a view along y itself takes z.
UP = np.array([0.0, 1.0, 0.0])
_UP_SEEN_ALONG_IT = np.array([0.0, 0.0, 1.0])
_ALONG = 0.95
# A view turned farther than this (cosine) from another takes no notice of how that one is held.
_OPPOSITE = -0.5
# Part of the picture left free around what it shows.
_MARGIN = 0.05


@dataclass(frozen=True)
class Camera:
    """Orthographic view.

    Attributes
    ----------
    centre, right, up, towards : (3,) float64
        Middle of the picture; unit axes, right-handed; `towards` points to the viewer.
    width : float
        Of the picture, in mesh units.
    clearance : float
        Distance in front of `centre` where the rays start, in mesh units.
    """

    centre: FloatArray
    right: FloatArray
    up: FloatArray
    towards: FloatArray
    width: float
    clearance: float

    @property
    def axes(self) -> FloatArray:
        """`right`, `up` and `towards` as rows (3, 3)."""
        return np.stack([self.right, self.up, self.towards])


@dataclass(frozen=True)
class View:
    """A camera and its picture of `size` (columns, rows), in pixels."""

    camera: Camera
    size: tuple[int, int]

    @property
    def plane(self) -> FloatArray:
        """Where rays start (3, 3), in mesh units: the point of column 0 and row 0, and the steps to the next ones."""
        camera = self.camera
        pixel = camera.width / self.size[0]
        steps = np.stack([camera.right, -camera.up]) * pixel
        middle = camera.centre + camera.clearance * camera.towards
        return np.vstack([middle - np.array(self.size) / 2 @ steps, steps])

    def places(self, points: Vertices) -> tuple[FloatArray, FloatArray]:
        """Columns (n,) and rows (n,) of points (n, 3), in pixels."""
        pixel = self.camera.width / self.size[0]
        right, down = self.camera.right / pixel, -self.camera.up / pixel
        shift = self.size[0] / 2 - self.camera.centre @ right, self.size[1] / 2 - self.camera.centre @ down
        return points @ right + shift[0], points @ down + shift[1]


def view_of(points: Vertices, towards: FloatArray, aspect: float, like: Camera | None = None) -> Camera:
    """Look at all of some points.

    Parameters
    ----------
    points : (n, 3) float64
        None give a view of the origin.
    towards : (3,) float64
        Unit vector to the viewer.
    aspect : float
        Width over height of the picture.
    like : Camera, optional
        Turned from this one the shortest way, so that a viewer who knows that view finds his way; else y is up.
    """
    right, up = _picture_axes(towards) if like is None else _axes_turned_from(like, towards)
    axes = np.stack([right, up, towards])
    local = (points if len(points) else np.zeros((1, 3))) @ axes.T
    low, high = local.min(axis=0), local.max(axis=0)
    extent = high - low
    width = float(max(extent[0], extent[1] * aspect)) * (1 + 2 * _MARGIN)
    centre = (0.5 * (low + high)) @ axes
    # A point has no width, a picture must have one.
    return Camera(centre, right, up, towards, width or 1.0, float(extent[2]))


def _axes_turned_from(other: Camera, towards: FloatArray) -> tuple[FloatArray, FloatArray]:
    cosine = float(other.towards @ towards)
    if cosine < _OPPOSITE:
        return _picture_axes(towards)
    # Rodrigues' formula for the rotation that takes one direction into the other without rolling.
    axis = np.cross(other.towards, towards)
    turned = other.up * cosine + np.cross(axis, other.up) + axis * (axis @ other.up) / (1 + cosine)
    up = turned / np.linalg.norm(turned)
    return np.cross(up, towards), up


def _picture_axes(towards: FloatArray) -> tuple[FloatArray, FloatArray]:
    above = _UP_SEEN_ALONG_IT if abs(towards @ UP) > _ALONG else UP
    right = np.cross(above, towards)
    right /= np.linalg.norm(right)
    return right, np.cross(towards, right)
