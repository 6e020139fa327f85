"""Seed points: where patches are anchored on the quad mesh."""

from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.normals import triangle_normals
from quadpatch.mesh.raycast import RayScene
from quadpatch.patches.ray_visibility import nearest_facing
from quadpatch.types import Frames, IntArray, QuadMesh, TriangleMesh, Vertices


@dataclass(frozen=True)
class Seeds:
    """Anchors of patches.

    Attributes
    ----------
    origins : (n, 3) float64
    frames : (n, 3, 3) float64
        Reference frame of the quad, the same for all its seeds.
    quad : (n,) int64
        Quad that each seed lies on.
    """

    origins: Vertices
    frames: Frames
    quad: IntArray

    def __len__(self) -> int:
        """Count of seeds."""
        return len(self.origins)


def seed_points(quad_mesh: QuadMesh, frames: Frames, n_offsets: int) -> Seeds:
    """Place a seed at the centre of each quad and `n_offsets` on the way to each of its corners.

    The paper's "centre and 4 k offsets", evenly spaced at j / (k + 1) of the way: towards the corners, because
    there the patches of neighbouring quads leave gaps between them, and short of them, because quads share them.

    Parameters
    ----------
    quad_mesh : QuadMesh
    frames : (n_quads, 3, 3) float64
    n_offsets : int
        k, not negative; 0 gives the centres alone.

    Returns
    -------
    Seeds
        4 k + 1 per quad, quad after quad, the centre first.
    """
    corners = quad_mesh.vertices[quad_mesh.quads]
    centre = corners.mean(axis=1, keepdims=True)
    way = np.arange(1, n_offsets + 1) / (n_offsets + 1)
    offsets = way[:, None, None] * (corners - centre)[:, None]
    origins = np.concatenate([centre, (centre[:, None] + offsets).reshape(len(corners), -1, 3)], axis=1)
    per_quad = 4 * n_offsets + 1
    return Seeds(
        origins.reshape(-1, 3),
        np.repeat(frames, per_quad, axis=0),
        np.repeat(np.arange(len(corners), dtype=np.int64), per_quad),
    )


def project_seeds(scene: RayScene, mesh: TriangleMesh, seeds: Seeds, reach: float) -> Seeds:
    """Move each seed along its z onto the surface, so that heights are small and centred.

    A quad is a chord of the surface: without this, patches on a curved part sit below it.

    Parameters
    ----------
    scene : RayScene
        Of `mesh`.
    mesh : TriangleMesh
        The base surface.
    seeds : Seeds
    reach : float
        In mesh units; a seed that sees no surface within it stays where it is.

    Returns
    -------
    Seeds
    """
    normals = triangle_normals(mesh.vertices, mesh.triangles)
    z = seeds.frames[:, 2]
    _, height = nearest_facing(scene, normals, seeds.origins, z, reach)
    return Seeds(seeds.origins + height[:, None] * z, seeds.frames, seeds.quad)
