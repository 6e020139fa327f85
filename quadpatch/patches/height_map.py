"""Height maps: the surface over the square grid of each patch."""

import numpy as np

from quadpatch.mesh.normals import triangle_normals
from quadpatch.mesh.raycast import RayScene
from quadpatch.patches.ray_visibility import nearest_facing
from quadpatch.patches.seeds import Seeds
from quadpatch.types import BoolArray, FloatArray, Frames, Patches, TriangleMesh, Vertices

# Farthest surface that still belongs to a patch, in patch lengths: as far as its border is from its centre.
REACH = 0.5
# Bins cast at once; at about 600 bytes each this bounds the memory to less than 100 MB.
_CHUNK = 150_000


def sample_height_maps(
    scene: RayScene, mesh: TriangleMesh, invented: BoolArray, seeds: Seeds, length: float, resolution: int
) -> Patches:
    """Sample the height of a surface over N x N bins around each seed.

    At every bin centre a ray runs both ways along z from the plane of the patch. The nearer surface counts whose
    outside looks along z, within half a patch length.

    Parameters
    ----------
    scene : RayScene
        Of `mesh`.
    mesh : TriangleMesh
    invented : (n_triangles,) bool
        True for the triangles that were not measured.
    seeds : Seeds
    length : float
        Side of the patches, in mesh units.
    resolution : int
        N, bins along one side.

    Returns
    -------
    Patches
        Known are the bins that see a measured triangle.
    """
    normals = triangle_normals(mesh.vertices, mesh.triangles)
    shape = (len(seeds), resolution, resolution)
    heights = np.zeros(shape)
    triangle = np.full(shape, -1, dtype=np.int64)
    per_chunk = max(1, _CHUNK // resolution**2)
    for start in range(0, len(seeds), per_chunk):
        chunk = slice(start, start + per_chunk)
        points = bin_centres(seeds.origins[chunk], seeds.frames[chunk], length, resolution)
        z = np.repeat(seeds.frames[chunk, 2], resolution**2, axis=0)
        seen, height = nearest_facing(scene, normals, points.reshape(-1, 3), z, REACH * length)
        triangle[chunk] = seen.reshape(-1, resolution, resolution)
        heights[chunk] = height.reshape(-1, resolution, resolution)
    is_seen = triangle >= 0
    is_known = is_seen.copy()
    is_known[is_seen] = ~invented[triangle[is_seen]]
    return Patches(seeds.origins, seeds.frames, length, heights, is_known, is_seen, triangle)


def bin_centres(origins: Vertices, frames: Frames, length: float, resolution: int) -> FloatArray:
    """Return the points (n, N, N, 3) where bins meet the plane of their patch, in mesh units.

    Rows run along y, columns along x, as described for `Patches`.
    """
    steps = ((np.arange(resolution) + 0.5) / resolution - 0.5) * length
    along_x = steps[:, None] * frames[:, None, 0]
    along_y = steps[:, None] * frames[:, None, 1]
    return origins[:, None, None] + along_y[:, :, None] + along_x[:, None, :]
