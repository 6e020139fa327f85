"""How two rims face each other across a gap.

Two rims that one strip of surface joins run in opposite directions where they are near each other, as both have the
surface on their left, and what is missing lies ahead of both: away from the surface on either side. Directions are
means over a window as wide as the gap, so that the teeth of a ragged rim do not count.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.mesh.normals import cross, length, normals_at, unit
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Vertices

# Two directions oppose each other, and one points ahead, within 60 degrees.
_LEAST_COSINE = 0.5
# Of the distances between two rims, the share that is taken for near: rims may face each other along a part only.
_NEAR_SHARE = 0.1
# Nearer than this share of an edge, rims touch.
_TOUCHING = 0.5
# The window reaches at least so many edges both ways, and no farther than this share of the rim.
_LEAST_EDGES = 2.0
_MOST_OF_RIM = 1 / 12


@dataclass(frozen=True)
class Rim:
    """A boundary loop with its directions.

    Attributes
    ----------
    points : (n, 3) float64
    tangents, outward, normals : (n, 3) float64
        Unit vectors along the loop, away from its surface, and of the surface.
    lengths : (n,) float64
        Of the rim that each vertex stands for, in mesh units.
    """

    points: Vertices
    tangents: FloatArray
    outward: FloatArray
    normals: FloatArray
    lengths: FloatArray

    @classmethod
    def of(cls, points: Vertices, normals: FloatArray, width: float) -> "Rim":
        """Average the directions of a loop.

        Parameters
        ----------
        points : (n, 3) float64
        normals : (n, 3) float64
            Of the surface at them.
        width : float
            How far a direction looks along the rim, in mesh units.
        """
        edges = length(np.roll(points, -1, axis=0) - points)
        along = np.concatenate([[0.0], np.cumsum(edges)])
        reach = min(max(width, _LEAST_EDGES * edges.mean()), _MOST_OF_RIM * along[-1])
        ahead, behind = (_at(points, along, along[:-1] + way) for way in (reach, -reach))
        tangents = unit(ahead - behind)
        # The mean over a window, by the difference of the integral at its ends.
        of_edges = (normals + np.roll(normals, -1, axis=0)) / 2
        total = np.concatenate([np.zeros((1, 3)), np.cumsum(of_edges * edges[:, None], axis=0)])
        mean = unit(_integral(total, along, along[:-1] + reach) - _integral(total, along, along[:-1] - reach))
        lengths = (edges + np.roll(edges, 1)) / 2
        return cls(points, tangents, unit(-cross(mean, tangents)), mean, lengths)

    @property
    def edge(self) -> float:
        """Mean length of an edge, in mesh units."""
        return float(self.lengths.mean())

    @property
    def perimeter(self) -> float:
        """Length, in mesh units."""
        return float(self.lengths.sum())


def _at(points: Vertices, along: FloatArray, where: FloatArray) -> Vertices:
    """Points (k, 3) at some ways (k,) along a closed polyline."""
    closed = np.concatenate([points, points[:1]])
    where = where % along[-1]
    return np.stack([np.interp(where, along, closed[:, k]) for k in range(3)], axis=1)


def _integral(total: FloatArray, along: FloatArray, where: FloatArray) -> FloatArray:
    """Values (k, 3) at some ways along a loop of an integral that goes on from turn to turn."""
    turns, rest = np.divmod(where, along[-1])
    rests = np.stack([np.interp(rest, along, total[:, k]) for k in range(3)], axis=1)
    return np.asarray(turns[:, None] * total[-1] + rests)


@dataclass(frozen=True)
class Sight:
    """What the vertices of one rim see of another.

    Attributes
    ----------
    nearest : (n,) int64
        The vertex of the other rim that is nearest, if possible where that runs the other way.
    distance : (n,) float64
        To the other rim there, in mesh units.
    faces : (n,) bool
        Whether both rims face each other there.
    along : (n,) float64
        Cosine between the directions of both rims at the vertex that is nearest wherever that runs.
    normals : (n,) float64
        Cosine between the normals of both surfaces.
    share : float
        Of the rim that faces the other one.
    """

    nearest: IntArray
    distance: FloatArray
    faces: BoolArray
    along: FloatArray
    normals: FloatArray
    share: float


@dataclass(frozen=True)
class Facing:
    """Two rims, and what each sees of the other.

    Attributes
    ----------
    rims : pair of Rim
    sights : pair of Sight
    """

    rims: tuple[Rim, Rim]
    sights: tuple[Sight, Sight]

    @property
    def share(self) -> float:
        """Share of the rim that faces the other one, of the rim where it is smaller."""
        return min(sight.share for sight in self.sights)

    @property
    def gap(self) -> float:
        """Mean distance between the rims where they face each other, else wherever they are, in mesh units."""
        return self._mean("distance")

    @property
    def agreement(self) -> float:
        """Mean cosine between the normals of both surfaces across the gap."""
        return self._mean("normals")

    @property
    def runs_opposite(self) -> bool:
        """Whether the rims run in opposite directions where they are nearest to each other."""
        total = 0.0
        for rim, sight in zip(self.rims, self.sights, strict=True):
            near = sight.distance <= 2 * np.quantile(sight.distance, _NEAR_SHARE)
            total += float(np.average(sight.along[near], weights=rim.lengths[near]))
        return total < 0

    def _mean(self, name: str) -> float:
        values = np.concatenate([getattr(sight, name) for sight in self.sights])
        faces = np.concatenate([sight.faces for sight in self.sights])
        lengths = np.concatenate([rim.lengths for rim in self.rims])
        return float(np.average(values, weights=lengths * faces if faces.any() else lengths))


def look_across(mesh: TriangleMesh, first: IntArray, second: IntArray) -> Facing:
    """Look from each of two boundary loops of a mesh at the other."""
    both = normals_at(mesh.vertices, mesh.triangles, np.concatenate([first, second]))
    points = mesh.vertices[first], mesh.vertices[second]
    return look_from(points, (both[: len(first)], both[len(first) :]))


def look_from(points: tuple[Vertices, Vertices], normals: tuple[FloatArray, FloatArray]) -> Facing:
    """Look from each of two closed loops at the other, by their points (n, 3) and the normals (n, 3) there."""
    width = min(float(np.quantile(cKDTree(b).query(a)[0], _NEAR_SHARE)) for a, b in (points, points[::-1]))
    one, other = (Rim.of(p, n, width) for p, n in zip(points, normals, strict=True))
    return Facing((one, other), (_sight(one, other, width), _sight(other, one, width)))


def _sight(rim: Rim, other: Rim, width: float) -> Sight:
    closest = np.asarray(cKDTree(other.points).query(rim.points)[1], np.int64)
    along = np.einsum("ij,ij->i", rim.tangents, other.tangents[closest])
    # Of a thin tube the wall that is closest may be the one opposite: what runs the other way counts as nearer.
    towards, wanted = (np.hstack([one.points, s * width * one.tangents]) for one, s in ((other, 1.0), (rim, -1.0)))
    nearest = np.asarray(cKDTree(towards).query(wanted)[1], np.int64)
    way, distance = _way_to(rim.points, other.points, nearest)
    ahead = np.einsum("ij,ij->i", rim.outward, way)
    met = -np.einsum("ij,ij->i", other.outward[nearest], way)
    # Of rims that all but touch, the way between them points anywhere.
    least = np.where(distance < _TOUCHING * min(rim.edge, other.edge), -np.inf, _LEAST_COSINE * distance)
    runs_back = np.einsum("ij,ij->i", rim.tangents, other.tangents[nearest]) < -_LEAST_COSINE
    faces = runs_back & (ahead >= least) & (met >= least)
    normals = np.einsum("ij,ij->i", rim.normals, other.normals[nearest])
    return Sight(nearest, distance, faces, along, normals, float(rim.lengths[faces].sum() / rim.perimeter))


def _way_to(points: Vertices, rim: Vertices, nearest: IntArray) -> tuple[FloatArray, FloatArray]:
    """Ways (n, 3) from points to the nearest point of the two edges at the nearest vertex of a rim; their lengths."""
    best, least = rim[nearest] - points, length(rim[nearest] - points)
    for step in (-1, 1):
        edge = np.roll(rim, -step, axis=0)[nearest] - rim[nearest]
        size = np.maximum(np.einsum("ij,ij->i", edge, edge), np.finfo(np.float64).tiny)
        share = np.clip(np.einsum("ij,ij->i", points - rim[nearest], edge) / size, 0, 1)
        way = rim[nearest] + share[:, None] * edge - points
        is_nearer = length(way) < least
        best[is_nearer], least[is_nearer] = way[is_nearer], length(way)[is_nearer]
    return best, least
