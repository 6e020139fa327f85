"""Look both ways along a direction for the surface that faces it."""

import numpy as np

from quadpatch.mesh.raycast import RayScene
from quadpatch.types import FloatArray, IntArray

# A surface seen at more than about 81 degrees off is a wall: its height over the plane says nothing.
LEAST_FACING = 0.15


def nearest_facing(
    scene: RayScene, normals: FloatArray, origins: FloatArray, directions: FloatArray, reach: float
) -> tuple[IntArray, FloatArray]:
    """Find the nearest surface along each line, ahead or behind, whose outside looks along the direction.

    Only the first surface on either side counts: what lies behind it is hidden.

    Parameters
    ----------
    scene : RayScene
    normals : (n_triangles, 3) float64
        Unit normals of the triangles of the scene.
    origins : (n, 3) float64
    directions : (n, 3) float64
        Of unit length.
    reach : float
        Surfaces farther away are not seen, in mesh units.

    Returns
    -------
    triangle : (n,) int64
        -1 where nothing is seen.
    height : (n,) float64
        Signed distance from the origin along the direction, in mesh units; 0 where nothing is seen.
    """
    # Both rays start a little on the other side of the origin, or a surface through it would be seen by neither.
    run_up = 2 * scene.resolution
    sides = []
    for sign in (1.0, -1.0):
        triangle, distance = scene.cast(origins - sign * run_up * directions, sign * directions, reach + run_up)
        facing = np.einsum("ij,ij->i", normals[triangle], directions) if len(normals) else np.zeros(len(origins))
        is_seen = (triangle >= 0) & (facing > LEAST_FACING) & (distance - run_up <= reach)
        sides.append((np.where(is_seen, triangle, -1), np.where(is_seen, sign * (distance - run_up), np.inf)))
    (ahead, height_ahead), (behind, height_behind) = sides
    is_ahead = np.abs(height_ahead) <= np.abs(height_behind)
    triangle = np.where(is_ahead, ahead, behind)
    height = np.where(is_ahead, height_ahead, height_behind)
    return triangle, np.where(triangle >= 0, height, 0.0)
