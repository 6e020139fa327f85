"""Points spread evenly over a surface; the one place that talks to trimesh."""

import numpy as np

from quadpatch.types import IntArray, TriangleMesh, Vertices


def sample_surface(mesh: TriangleMesh, n_points: int, rng: np.random.Generator) -> tuple[Vertices, IntArray]:
    """Draw points from a surface, every part of it as likely as its area.

    Parameters
    ----------
    mesh : TriangleMesh
    n_points : int
    rng : numpy.random.Generator

    Returns
    -------
    points : (n_points, 3) float64
        None where the surface has no area.
    triangle : (n_points,) int64
        The triangle that each point lies on.
    """
    from trimesh import Trimesh  # noqa: PLC0415  takes a quarter of a second to load
    from trimesh.sample import sample_surface as sample  # noqa: PLC0415

    surface = Trimesh(mesh.vertices, mesh.triangles, process=False)
    if not n_points or not surface.area > 0:
        return np.zeros((0, 3)), np.zeros(0, np.int64)
    points, triangle = sample(surface, n_points, seed=rng)[:2]
    return np.asarray(points, np.float64), np.asarray(triangle, np.int64)
