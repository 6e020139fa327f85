"""The sheet of a task that moves vertices: the mesh before and after, and close-ups of where most has changed."""

from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.formats.output_files import write_whole
from quadpatch.mesh.measures import diagonal
from quadpatch.mesh.normals import area_vectors
from quadpatch.preview.invented import TINT
from quadpatch.preview.pair import moved_pair
from quadpatch.preview.parts import part_of
from quadpatch.preview.png import png_bytes
from quadpatch.preview.shading import CLAY
from quadpatch.preview.sheet import (
    N_CANDIDATES,
    N_CLOSE_UPS,
    SWATCH,
    blank_sheet,
    draw_close_ups,
    draw_legend,
    draw_overview,
    overview_camera,
)
from quadpatch.preview.thinning import MOST_TRIANGLES, thinned
from quadpatch.preview.viewpoints import close_ups
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh

# A close-up shows the surface in a ball of this radius, as a share of the bounding box's diagonal, and around it.
_RADIUS = 0.05
# Balls that are tried, spread over the triangles that changed.
_N_BALLS = 300


def render_comparison(before: TriangleMesh, after: TriangleMesh, change: BoolArray | FloatArray, path: Path) -> None:
    """Draw a mesh before and after a task, as `comparison_png` does, into a file."""
    write_whole(path, comparison_png(before, after, change))


def comparison_png(before: TriangleMesh, after: TriangleMesh, change: BoolArray | FloatArray) -> bytes:
    """Draw a mesh before and after a task, and close-ups of where most has changed.

    Parameters
    ----------
    before, after : TriangleMesh
        In the same place; triangles with a corner that is not finite are not drawn.
    change : (n_triangles of `after`,) bool or float64
        What is tinted; 0..1 for how strongly.

    Returns
    -------
    bytes
        A PNG file.

    Raises
    ------
    EmptyMeshError
        If `after` has no triangle of any area.
    """
    is_drawn = _is_finite(after)
    change = change[is_drawn]
    before, after = _drawn(before), _drawn(after)
    is_large = len(after.triangles) > MOST_TRIANGLES
    if is_large:
        before, (after, kept) = thinned(before, [])[0], thinned(after, [])
        change = change[kept]
    pair = moved_pair(before, after, change, is_joined=is_large)
    changed = np.asarray(change > 0)
    camera = overview_camera(pair, changed)
    places = [part_of(pair.after, triangles) for triangles in changed_places(pair.after, change, N_CANDIDATES)]
    cameras = close_ups(pair.scene, places, camera, N_CLOSE_UPS)
    sheet = blank_sheet(has_close_ups=bool(cameras))
    draw_overview(sheet, pair, camera)
    if cameras:
        draw_close_ups(sheet, pair, cameras, {})
    if change.dtype == np.bool_:
        draw_legend(sheet, "changed", "as before", np.tile(TINT, (SWATCH[0], 1)))
    else:
        draw_legend(sheet, "moved far", "not moved", CLAY + np.linspace(0, 1, SWATCH[0])[:, None] * (TINT - CLAY))
    return png_bytes(sheet.image)


def _is_finite(mesh: TriangleMesh) -> BoolArray:
    is_there = np.asarray(np.isfinite(mesh.vertices).all(axis=1))
    return np.asarray(is_there[mesh.triangles].all(axis=1))


def _drawn(mesh: TriangleMesh) -> TriangleMesh:
    """Leave out triangles with missing corners, which a ray tracer does not bear."""
    return TriangleMesh(np.nan_to_num(mesh.vertices), mesh.triangles[_is_finite(mesh)])


def changed_places(mesh: TriangleMesh, change: BoolArray | FloatArray, most: int) -> list[IntArray]:
    """Find the places where most of a surface has changed.

    Parameters
    ----------
    mesh : TriangleMesh
    change : (n_triangles,) bool or float64
    most : int

    Returns
    -------
    list of (n,) int64
        Triangles of each place, the most changed one first; no two overlap.
    """
    weight = change * np.linalg.norm(area_vectors(mesh.vertices, mesh.triangles), axis=1)
    chosen = np.flatnonzero(weight > 0)
    if len(chosen) == 0:
        return []
    centroids = mesh.vertices[mesh.triangles].mean(axis=1)
    tried = chosen[:: max(len(chosen) // _N_BALLS, 1)]
    radius = _RADIUS * diagonal(mesh)
    balls = cKDTree(centroids).query_ball_point(centroids[tried], radius)
    score = np.array([weight[ball].sum() for ball in balls])
    places: list[IntArray] = []
    centres = np.zeros((0, 3))
    # The loop runs over the balls that are tried, three hundred of them or a few more.
    for i in np.argsort(-score, kind="stable").tolist():
        centre = centroids[tried[i]]
        if len(places) < most and (np.linalg.norm(centres - centre, axis=1) > 2 * radius).all():
            places.append(np.sort(np.array(balls[i], dtype=np.int64)))
            centres = np.vstack([centres, centre])
    return places
