"""Damage of the kinds that real scans show. Each takes a mesh and a generator, and gives a damaged mesh."""

from collections.abc import Callable

import numpy as np

from quadpatch.types import FloatArray, IntArray, TriangleMesh
from tests.fuzz.bases import any_base
from tests.quadpatch.faulty_shapes import (
    grown,
    loops_of,
    rim_edges,
    with_flap,
    with_island,
    with_split_rim_edge,
    with_triangle_at_rim,
)
from tests.quadpatch.shapes import joined

Damage = Callable[[TriangleMesh, np.random.Generator], TriangleMesh]


def blobs(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Remove one to three ragged groups of triangles."""
    is_removed = np.zeros(len(mesh.triangles), dtype=bool)
    for _ in range(int(rng.integers(1, 4))):
        blob = np.zeros(len(mesh.triangles), dtype=bool)
        blob[rng.integers(len(blob))] = True
        for _ in range(int(rng.integers(1, 5))):
            is_near = np.isin(mesh.triangles, mesh.triangles[blob]).any(axis=1)
            blob |= is_near & (rng.random(len(blob)) < 0.7)
            if blob.sum() > 0.1 * len(blob):
                break
        is_removed |= blob
    return TriangleMesh(mesh.vertices, mesh.triangles[~is_removed])


def jitter(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Move all vertices by up to half an edge."""
    noise = float(rng.choice([0.02, 0.1, 0.3])) * _edge_length(mesh)
    return TriangleMesh(mesh.vertices + rng.normal(0, noise, mesh.vertices.shape), mesh.triangles)


def duplicate_faces(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Repeat some triangles, half of them at rims, a few of them turned."""
    faces = np.concatenate([_some(mesh.triangles, rng, 5), _some(rim_edges(mesh.triangles), rng, 5)])
    turned = rng.random(len(faces)) < 0.2
    faces[turned] = faces[turned, ::-1]
    return grown(mesh, [], faces)


def flipped_faces(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Turn some triangles around."""
    triangles = mesh.triangles.copy()
    chosen = rng.random(len(triangles)) < float(rng.choice([0.003, 0.03]))
    triangles[chosen] = triangles[chosen, ::-1]
    return TriangleMesh(mesh.vertices, triangles)


def island(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Put a loose disc into a hole."""
    loop = _hole(mesh, rng)
    if loop is None:
        return mesh
    size, rise = float(rng.uniform(0.2, 0.6)), float(rng.choice([0.0, 0.1, 0.2, 0.5]))
    return with_island(mesh, loop, size, rise, turned=bool(rng.random() < 0.3))


def flap(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Hang a strip of surface into a hole, into the air, or back over its rim."""
    loop = _hole(mesh, rng)
    if loop is None:
        return mesh
    return with_flap(mesh, loop, float(rng.uniform(-0.4, 0.8)), float(rng.uniform(-0.3, 0.5)))


def needles(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Split rim edges close to an end, and glue flat triangles to others."""
    for _ in range(int(rng.integers(1, 5))):
        n = len(rim_edges(mesh.triangles))
        if not n:
            break
        small = float(10 ** rng.uniform(-12, -1))
        if rng.random() < 0.5:
            mesh = with_split_rim_edge(mesh, int(rng.integers(n)), small)
        else:
            mesh = with_triangle_at_rim(mesh, int(rng.integers(n)), float(rng.uniform(0.05, 0.95)), small)
    return mesh


def zero_areas(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Glue triangles without area to rims."""
    for _ in range(int(rng.integers(1, 5))):
        n = len(rim_edges(mesh.triangles))
        if n:
            mesh = with_triangle_at_rim(mesh, int(rng.integers(n)), float(rng.choice([0.0, 0.3, 0.5, 0.9])), 0.0)
    return mesh


def fins(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Stand triangles on edges, at rims and elsewhere."""
    for corners in (_some(rim_edges(mesh.triangles), rng, 2), _some(mesh.triangles, rng, 2)):
        for start, end, _ in corners.tolist():
            middle = mesh.vertices[[start, end]].mean(axis=0)
            tip = middle + rng.normal(0, 0.7 * _edge_length(mesh), 3)
            mesh = grown(mesh, [tip], [[start, end, -1]])
    return mesh


def t_junctions(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Split triangles at one edge, not their neighbours there."""
    for face in rng.permutation(len(mesh.triangles))[: int(rng.integers(1, 6))].tolist():
        start, end, opposite = mesh.triangles[face].tolist()
        middle = mesh.vertices[[start, end]].mean(axis=0)
        halved = mesh.triangles.copy()
        halved[face] = start, len(mesh.vertices), opposite
        mesh = grown(TriangleMesh(mesh.vertices, halved), [middle], [[-1, end, opposite]])
    return mesh


def near_duplicates(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Give some triangles corners of their own, a few units in the last place beside the shared ones."""
    for face in rng.permutation(len(mesh.triangles))[: int(rng.integers(1, 8))].tolist():
        corners = mesh.vertices[mesh.triangles[face]]
        own = corners + rng.integers(-2, 3, (3, 3)) * np.spacing(np.abs(corners).max())
        rest = TriangleMesh(mesh.vertices, np.delete(mesh.triangles, face, axis=0))
        mesh = grown(rest, own, [[-1, -2, -3]])
    return mesh


def pieces(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Add other meshes beside, through or within this one."""
    for _ in range(int(rng.integers(1, 4))):
        other = blobs(any_base(rng), rng)
        size, place = float(10 ** rng.uniform(-1.5, 0)), rng.normal(0, 1, 3) * rng.choice([0.3, 2.0])
        mesh = joined(mesh, TriangleMesh(size * other.vertices + place, other.triangles))
    return mesh


def pinches(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Make two vertices of rims one, and hang triangles on edges that have two already."""
    loops = loops_of(mesh)
    triangles = mesh.triangles.copy()
    if loops:
        loop = loops[int(rng.integers(len(loops)))]
        one, other = rng.choice(loop, 2)
        triangles[triangles == one] = other
    is_proper = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    return fins(TriangleMesh(mesh.vertices, triangles[is_proper]), rng)


def scale(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Give it another unit: lengths times 1e-6 to 1e6."""
    return TriangleMesh(mesh.vertices * 10 ** rng.uniform(-6, 6), mesh.triangles)


def offset(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Move it up to a million units away from the origin."""
    return TriangleMesh(mesh.vertices + rng.uniform(-1e6, 1e6, 3), mesh.triangles)


def nothing_else(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Leave it at the holes."""
    return mesh


DAMAGES: dict[str, Damage] = {
    "holes": nothing_else,
    "jitter": jitter,
    "duplicates": duplicate_faces,
    "flips": flipped_faces,
    "islands": island,
    "flaps": flap,
    "needles": needles,
    "zero areas": zero_areas,
    "fins": fins,
    "T-junctions": t_junctions,
    "near-duplicates": near_duplicates,
    "pieces": pieces,
    "long rims": nothing_else,
    "pinches": pinches,
    "scale": scale,
    "offset": offset,
}


def _some(rows: IntArray, rng: np.random.Generator, most: int) -> IntArray:
    return rows[rng.permutation(len(rows))[: int(rng.integers(1, most + 1))]]


def _hole(mesh: TriangleMesh, rng: np.random.Generator) -> IntArray | None:
    """Draw a loop of six edges or more, rather a small one."""
    loops = [loop for loop in loops_of(mesh) if len(loop) >= 6]
    loops.sort(key=lambda loop: float(np.linalg.norm(np.ptp(mesh.vertices[loop], axis=0))))
    return loops[int(rng.integers(min(2, len(loops))))] if loops else None


def _edge_length(mesh: TriangleMesh) -> float:
    corners: FloatArray = mesh.vertices[mesh.triangles]
    return float(np.median(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)))
