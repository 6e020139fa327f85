"""Height maps of a cloud of points: the mean height of the points that fall into each bin.

This is the paper's own way (its section 3): a dense cloud stands for the surface, and a patch at a seed holds the
points in the ball around it whose great circle goes through the corners of its square. The default recipe casts rays
instead (`quadpatch.patches.height_map`).

References
----------
K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019, section 3.
"""

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.mesh.measures import surface_area
from quadpatch.mesh.normals import triangle_normals
from quadpatch.mesh.sampling import sample_surface
from quadpatch.patches.ray_visibility import LEAST_FACING
from quadpatch.patches.seeds import Seeds
from quadpatch.types import FloatArray, IntArray, Patches, TriangleMesh, Vertices

# Points in a bin, in the mean. With ten, one bin in twenty thousand gets none.
POINTS_PER_BIN = 10.0
# Of a whole cloud; 72 bytes each.
MOST_POINTS = 4_000_000


def ball_radius(length: float) -> float:
    """Radius r of the ball around a seed whose square has the side sqrt(2) r; mesh units."""
    return length / float(np.sqrt(2.0))


def sample_cloud(
    mesh: TriangleMesh, seeds: Seeds, length: float, resolution: int, rng: np.random.Generator
) -> tuple[Vertices, FloatArray]:
    """Spread points over the surface around some seeds, about ten for each bin.

    Parameters
    ----------
    mesh : TriangleMesh
    seeds : Seeds
    length : float
        Side of the patches, in mesh units.
    resolution : int
    rng : numpy.random.Generator

    Returns
    -------
    points, normals : (n_points, 3) float64
        At most `MOST_POINTS`; normals are those of their triangles.
    """
    corners = mesh.vertices[mesh.triangles]
    centroid = corners.mean(axis=1)
    if not len(seeds) or not len(centroid):
        return np.zeros((0, 3)), np.zeros((0, 3))
    extent = np.linalg.norm(corners - centroid[:, None], axis=2).max(axis=1)
    distance, _ = cKDTree(seeds.origins).query(centroid)
    part = TriangleMesh(mesh.vertices, mesh.triangles[distance <= ball_radius(length) + extent])
    normals = triangle_normals(part.vertices, part.triangles)
    wanted = POINTS_PER_BIN * surface_area(part) * (resolution / length) ** 2
    points, triangle = sample_surface(part, int(min(wanted, MOST_POINTS)), rng)
    return points, normals[triangle]


def point_height_maps(points: Vertices, normals: FloatArray, seeds: Seeds, length: float, resolution: int) -> Patches:
    """Take the mean height of a cloud in N x N bins around each seed.

    A point counts if it lies in the ball around the seed, over the square, and its normal looks along z.

    Parameters
    ----------
    points, normals : (n_points, 3) float64
        All of them measured; there is none in a hole.
    seeds : Seeds
    length : float
        Side of the patches, in mesh units.
    resolution : int
        N, bins along one side.

    Returns
    -------
    Patches
        Seen and known are the bins that hold a point. No triangle is named.
    """
    shape = (len(seeds), resolution, resolution)
    heights, count = np.zeros((len(seeds), resolution**2)), np.zeros((len(seeds), resolution**2))
    tree = cKDTree(points.reshape(-1, 3))
    # Loop over patches, not points.
    for i in range(len(seeds)):
        near = np.array(tree.query_ball_point(seeds.origins[i], ball_radius(length)), np.int64)
        place, height = _in_square(points[near], normals[near], seeds, i, length, resolution)
        count[i] = np.bincount(place, minlength=resolution**2)
        heights[i] = np.bincount(place, height, minlength=resolution**2)
    known = count > 0
    mean = np.divide(heights, count, out=np.zeros_like(heights), where=known)
    known = known.reshape(shape)
    return Patches(seeds.origins, seeds.frames, length, mean.reshape(shape), known, known, np.full(shape, -1, np.int64))


def _in_square(
    points: Vertices, normals: FloatArray, seeds: Seeds, i: int, length: float, resolution: int
) -> tuple[IntArray, FloatArray]:
    """Bin and height of those points that lie over a seed's square and face its z."""
    frame = seeds.frames[i]
    local = (points - seeds.origins[i]) @ frame.T
    cell = np.floor((local[:, :2] / length + 0.5) * resolution).astype(np.int64)
    is_in = ((cell >= 0) & (cell < resolution)).all(axis=1) & (normals @ frame[2] > LEAST_FACING)
    cell = cell[is_in]
    return cell[:, 1] * resolution + cell[:, 0], local[is_in, 2]
