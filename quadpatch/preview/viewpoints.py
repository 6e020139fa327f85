"""Where to look from."""

import numpy as np

from quadpatch.mesh.raycast import RayScene
from quadpatch.preview.camera import UP, Camera, view_of
from quadpatch.preview.parts import Part
from quadpatch.types import FloatArray

# Directions tried for a view: about 20 degrees between neighbours.
_N_DIRECTIONS = 96
# What counts in an overview beside the invented surface in sight (at most 1): the outside of the mesh, its inside,
# and a view from straight above or below.
_OUTSIDE, _INSIDE, _STEEP = 0.6, -0.6, -0.35
# A close-up is this many times as wide as its hole.
_SURROUNDINGS = 2.4
# The view straight down on a hole is taken if at least this share of it is clear.
_MOSTLY_CLEAR = 0.9
# A hole of which less than this share shows at once bulges or hides.
_WELL_SEEN = 0.6
# A surface that shows this many times more of its inside is turned inside out; an open one shows both alike.
_INSIDE_OUT = 1.5


def overview(scene: RayScene, whole: Part, invented: Part | None, aspect: float) -> Camera:
    """Look at the whole mesh from where most of the invented surface shows, and more of its outside than inside."""
    directions = spread_directions(_N_DIRECTIONS)
    outside, inside = visible_areas(scene, whole, directions), visible_areas(scene, whole.flipped(), directions)
    score = _OUTSIDE * _relative(outside) + _INSIDE * inside / max(outside.max(), inside.max(), _tiny())
    score += _STEEP * (directions @ UP) ** 2
    if invented is not None:
        score += _relative(visible_areas(scene, invented, directions))
    return view_of(whole.corners, directions[np.argmax(score)], aspect)


def close_ups(scene: RayScene, holes: list[Part], like: Camera, most: int) -> dict[int, Camera]:
    """Look at the first few filled holes in square pictures, those that can hardly be seen from anywhere last.

    Each is held like the overview, turned to the hole. The keys are positions in the list of holes.
    """
    views = [_close_up(scene, hole, like) for hole in holes]
    # Sorting is stable: among the visible ones the order stays.
    order = sorted(range(len(views)), key=lambda i: views[i][1] < _WELL_SEEN)
    return {i: views[i][0] for i in order[:most]}


def most_seen_from(scene: RayScene, part: Part) -> FloatArray:
    """Find the direction (3,) from which most of the outside of a part shows; a unit vector to the viewer."""
    directions = spread_directions(_N_DIRECTIONS)
    return np.asarray(directions[np.argmax(visible_areas(scene, part, directions, _SURROUNDINGS * part.diagonal))])


def _close_up(scene: RayScene, hole: Part, like: Camera) -> tuple[Camera, float]:
    """Look straight down on a filled hole, or from where most of it shows; with the share of its area that does."""
    clearance = _SURROUNDINGS * hole.diagonal
    mean = hole.area_vectors.sum(axis=0)
    length = float(np.linalg.norm(mean))
    towards = mean / length if length > 0 else UP
    shown = float(visible_areas(scene, hole, towards[None], clearance)[0])
    if shown < _MOSTLY_CLEAR * np.maximum(hole.area_vectors @ towards, 0).sum():
        directions = spread_directions(_N_DIRECTIONS)
        areas = visible_areas(scene, hole, directions, clearance)
        towards, shown = directions[np.argmax(areas)], float(areas.max())
    tight = view_of(hole.corners, towards, 1.0, like)
    camera = Camera(tight.centre, tight.right, tight.up, towards, tight.width * _SURROUNDINGS, clearance)
    return camera, shown / max(float(np.linalg.norm(hole.area_vectors, axis=1).sum()), _tiny())


def is_inside_out(scene: RayScene, whole: Part) -> bool:
    """Whether someone outside mostly sees the inside of the surface."""
    directions = spread_directions(_N_DIRECTIONS // 8)
    outside, inside = (visible_areas(scene, part, directions).sum() for part in (whole, whole.flipped()))
    return bool(inside > _INSIDE_OUT * outside)


def visible_areas(scene: RayScene, part: Part, directions: FloatArray, clearance: float = np.inf) -> FloatArray:
    """Measure how much of the outside of a part shows from each direction.

    Parameters
    ----------
    scene : RayScene
        What may stand in the way.
    part : Part
    directions : (n, 3) float64
        Unit vectors to the viewer.
    clearance : float
        Only what is nearer than this to the surface hides it, in mesh units.

    Returns
    -------
    (n,) float64
        Projected areas, of the sampled triangles, twice.
    """
    facing = part.area_vectors @ directions.T
    triangle, direction = np.nonzero(facing > 0)
    length = np.linalg.norm(part.area_vectors, axis=1, keepdims=True)
    outwards = np.divide(part.area_vectors, length, out=np.zeros_like(part.area_vectors), where=length > 0)
    # Off the surface, or every point would hide itself.
    start = part.centres + 10 * scene.resolution * outwards
    is_hidden = scene.is_hidden(start[triangle], directions[direction], clearance)
    shown = facing[triangle, direction] * ~is_hidden
    return np.asarray(np.bincount(direction, weights=shown, minlength=len(directions)), dtype=np.float64)


def spread_directions(count: int) -> FloatArray:
    """Directions (n, 3) spread evenly over the sphere (Fibonacci lattice)."""
    k = np.arange(count)
    height = 1 - (2 * k + 1) / count
    azimuth = k * np.pi * (3 - np.sqrt(5))
    radius = np.sqrt(1 - height**2)
    return np.stack([radius * np.sin(azimuth), height, radius * np.cos(azimuth)], axis=1)


def _relative(areas: FloatArray) -> FloatArray:
    return areas / max(float(areas.max()), _tiny())


def _tiny() -> float:
    return float(np.finfo(np.float64).tiny)
