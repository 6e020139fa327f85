"""Parts of a mesh that a picture is about: all of it, its invented surface, one filled hole."""

from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.normals import area_vectors
from quadpatch.mesh.topology import face_components
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Vertices

# Triangles of a part that speak for it when a view is chosen.
_SAMPLE = 800
# Pieces smaller than this part of the largest one are stray bits that a picture may cut off. The whole surface is no
# measure: of more than a hundred equal pieces each would be one.
_STRAY = 0.01


@dataclass(frozen=True)
class Part:
    """Some triangles of a mesh.

    Attributes
    ----------
    corners : (n, 3) float64
        Their corner points.
    centres : (m, 3) float64
        The centres of up to 800 of them.
    area_vectors : (m, 3) float64
        The outward normals of those, as long as twice the areas.
    """

    corners: Vertices
    centres: Vertices
    area_vectors: FloatArray

    @property
    def diagonal(self) -> float:
        """Diagonal of the bounding box, in mesh units."""
        return float(np.linalg.norm(np.ptp(self.corners, axis=0))) if len(self.corners) else 0.0

    def flipped(self) -> "Part":
        """Turn the triangles over."""
        return Part(self.corners, self.centres, -self.area_vectors)


def part_of(mesh: TriangleMesh, triangles: IntArray) -> Part:
    """Take some triangles (n,) of a mesh; none give a part without corners."""
    sample = mesh.triangles[triangles[:: max(-(-len(triangles) // _SAMPLE), 1)]]
    corners = mesh.vertices[np.unique(mesh.triangles[triangles])]
    return Part(corners, mesh.vertices[sample].mean(axis=1), area_vectors(mesh.vertices, sample))


def main_pieces(mesh: TriangleMesh) -> IntArray:
    """Triangles (n,) of all pieces but stray bits, which would make a picture small; none of a mesh without any."""
    if not len(mesh.triangles):
        return np.zeros(0, dtype=np.int64)
    label = face_components(mesh.triangles, len(mesh.vertices))
    area = np.linalg.norm(area_vectors(mesh.vertices, mesh.triangles), axis=1)
    share = np.bincount(label, weights=area)
    return np.flatnonzero((share >= _STRAY * share.max())[label])


def filled_holes(mesh: TriangleMesh, invented: BoolArray, most: int) -> list[IntArray]:
    """Find the largest filled holes: connected groups of invented triangles.

    Large is what spans a large opening: the length of the sum of the area vectors, which does not grow when a fill
    bulges.

    Parameters
    ----------
    mesh : TriangleMesh
    invented : (n_triangles,) bool
    most : int

    Returns
    -------
    list of (n,) int64
        Triangles of each, largest first.
    """
    chosen = np.flatnonzero(invented)
    if len(chosen) == 0:
        return []
    label = face_components(mesh.triangles[chosen], len(mesh.vertices))
    vectors = area_vectors(mesh.vertices, mesh.triangles[chosen])
    opening = np.linalg.norm(np.stack([np.bincount(label, weights=vectors[:, axis]) for axis in range(3)]), axis=0)
    largest = np.argsort(-opening, kind="stable")[:most]
    return [chosen[label == k] for k in largest if opening[k] > 0]


def touching(mesh: TriangleMesh, chosen: BoolArray) -> BoolArray:
    """Triangles (n_triangles,) that share a vertex with a chosen one, those themselves among them."""
    is_shared = np.zeros(len(mesh.vertices), dtype=bool)
    is_shared[mesh.triangles[chosen]] = True
    a, b, c = is_shared[mesh.triangles.T]
    return np.asarray(a | b | c)
