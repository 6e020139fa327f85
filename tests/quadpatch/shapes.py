"""Meshes that several tests build."""

from pathlib import Path

import numpy as np

from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh


def joined(*meshes: TriangleMesh) -> TriangleMesh:
    """Put meshes beside each other in one."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return TriangleMesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.triangles + start for mesh, start in zip(meshes, starts[:-1], strict=True)]),
    )


def open_grid(n: int, width: float | None = None) -> TriangleMesh:
    """Build a flat square of n x n vertices around the origin, z up; one mesh unit between them, or `width` in all."""
    width = n - 1.0 if width is None else width
    along = np.linspace(-width / 2, width / 2, n)
    y, x = np.meshgrid(along, along, indexing="ij")
    index = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return TriangleMesh(np.stack([x.ravel(), y.ravel(), np.zeros(n * n)], axis=1), triangles)


def bumpy_plate(n: int, width: float, seed: int = 0) -> TriangleMesh:
    """Build a smooth landscape over a square of irregular vertices; nothing in it is symmetric or equal."""
    flat = open_grid(n, width)
    rng = np.random.default_rng(seed)
    step = width / (n - 1)
    x, y = (flat.vertices[:, :2] + rng.uniform(-0.2 * step, 0.2 * step, (n * n, 2))).T
    z = 0.05 * width * (np.sin(5.1 * x / width + 0.3) * np.cos(4.3 * y / width) + (x / width) ** 2)
    return TriangleMesh(np.stack([x, y, z], axis=1), flat.triangles)


def sphere(n_subdivisions: int, radius: float = 1.0) -> TriangleMesh:
    """Subdivide an icosahedron: 10 * 4**n + 2 vertices on a sphere around the origin."""
    golden = (1 + np.sqrt(5)) / 2
    seed = np.array([[-1, golden, 0], [1, golden, 0], [-1, -golden, 0], [1, -golden, 0]])
    vertices = np.concatenate([seed, np.roll(seed, 1, axis=1), np.roll(seed, 2, axis=1)])
    distance = np.linalg.norm(vertices[:, None] - vertices[None], axis=2)
    near = distance < 2.1
    triangles = np.array(
        [(i, j, k) for i in range(12) for j in range(i) for k in range(j) if near[i, j] and near[j, k] and near[i, k]]
    )
    corners = vertices[triangles]
    inward = np.einsum(
        "ij,ij->i", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), corners[:, 0]
    )
    triangles = np.where((inward < 0)[:, None], triangles[:, ::-1], triangles)
    for _ in range(n_subdivisions):
        vertices, triangles = _subdivided(vertices, triangles)
    return TriangleMesh(radius * vertices / np.linalg.norm(vertices, axis=1, keepdims=True), triangles)


def _subdivided(vertices: FloatArray, triangles: IntArray) -> tuple[FloatArray, IntArray]:
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    unique, of_edge = np.unique(edges, axis=0, return_inverse=True)
    middle = len(vertices) + of_edge.reshape(-1, 3)
    (a, b, c), (ab, bc, ca) = triangles.T, middle.T
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return (
        np.concatenate([vertices, vertices[unique].mean(axis=1)]),
        np.concatenate([np.stack(part, axis=1) for part in parts]),
    )


def cylinder(n_around: int, n_along: int, radius: float = 1.0, length: float = 4.0) -> TriangleMesh:
    """Build an open cylinder around the z axis, every second ring turned by half a step, normals outwards."""
    ring, column = np.divmod(np.arange(n_around * n_along), n_around)
    angle = 2 * np.pi * (column + 0.5 * (ring % 2)) / n_around
    z = length * (ring / (n_along - 1) - 0.5)
    triangles = []
    for i in range(n_along - 1):
        here, there = i * n_around + np.arange(n_around), (i + 1) * n_around + np.arange(n_around)
        after, beyond = np.roll(here, -1), np.roll(there, -1)
        if i % 2 == 0:
            triangles += [np.stack([here, after, there], 1), np.stack([after, beyond, there], 1)]
        else:
            triangles += [np.stack([here, beyond, there], 1), np.stack([here, after, beyond], 1)]
    return TriangleMesh(np.stack([radius * np.cos(angle), radius * np.sin(angle), z], 1), np.concatenate(triangles))


def torus(n_around: int, n_tube: int, radius: float = 3.0) -> TriangleMesh:
    """Build a torus around the z axis with a tube of radius 1, every second ring turned by half a step."""
    around = np.arange(n_around) * 2 * np.pi / n_around
    tube = np.arange(n_tube) * 2 * np.pi / n_tube
    u, v = np.meshgrid(around, tube, indexing="ij")
    u = u + (np.arange(n_tube) % 2) * np.pi / n_around
    vertices = np.stack([(radius + np.cos(v)) * np.cos(u), (radius + np.cos(v)) * np.sin(u), np.sin(v)], axis=-1)
    i, k = np.meshgrid(np.arange(n_around), np.arange(n_tube), indexing="ij")
    a, b, c, d = ((i + p) % n_around * n_tube + (k + q) % n_tube for p, q in ((0, 0), (1, 0), (1, 1), (0, 1)))
    odd = (k % 2 == 1)[..., None]
    first = np.where(odd, np.stack([a, b, c], axis=-1), np.stack([a, b, d], axis=-1))
    second = np.where(odd, np.stack([a, c, d], axis=-1), np.stack([b, c, d], axis=-1))
    return TriangleMesh(vertices.reshape(-1, 3), np.concatenate([first.reshape(-1, 3), second.reshape(-1, 3)]))


def without(mesh: TriangleMesh, gone: BoolArray) -> TriangleMesh:
    """Remove every triangle with a corner among some vertices (n,); vertices stay."""
    return TriangleMesh(mesh.vertices, mesh.triangles[~gone[mesh.triangles].any(axis=1)])


def relief(n: int, width: float = 2.0, depth: float = 0.05, waves: int = 6) -> TriangleMesh:
    """Build a plate that carries a gyroid's section: strong, repeating texture, on irregular vertices."""
    flat = open_grid(n, width)
    step = width / (n - 1)
    x, y = (flat.vertices[:, :2] + np.random.default_rng(0).uniform(-0.2 * step, 0.2 * step, (n * n, 2))).T
    u, v = 2 * np.pi * waves * x / width, 2 * np.pi * waves * y / width
    z = depth * (np.sin(u) * np.cos(v) + np.sin(v) * np.cos(0.3) + np.sin(0.3) * np.cos(u))
    return TriangleMesh(np.stack([x, y, z], axis=1), flat.triangles)


def punched(mesh: TriangleMesh, *centres: tuple[float, float, float], radius: float) -> TriangleMesh:
    """Remove every triangle with a corner in one of some balls; vertices stay, also those without triangles."""
    gone = np.zeros(len(mesh.vertices), bool)
    for centre in centres:
        gone |= np.linalg.norm(mesh.vertices - np.array(centre), axis=1) < radius
    return TriangleMesh(mesh.vertices, mesh.triangles[~gone[mesh.triangles].any(axis=1)])


def on_surface(mesh: TriangleMesh, *places: tuple[float, float]) -> list[tuple[float, float, float]]:
    """Find the vertices of a sheet that are nearest to some places (x, y), seen from above."""
    nearest = [int(np.linalg.norm(mesh.vertices[:, :2] - place, axis=1).argmin()) for place in places]
    return [(x, y, z) for x, y, z in mesh.vertices[nearest].tolist()]


def plate_with_disc(n_rim: int, n_rings: int = 3) -> TriangleMesh:
    """Build a flat plate around a round hole of radius 1: rings of equal triangles, z up; the rim comes first."""
    step = 2 * np.pi / n_rim
    ring, column = np.divmod(np.arange(n_rim * (n_rings + 1)), n_rim)
    angle, radius = step * (column + 0.5 * (ring % 2)), 1 + step * ring
    triangles = []
    for k in range(n_rings):
        here, there = k * n_rim + np.arange(n_rim), (k + 1) * n_rim + np.arange(n_rim)
        after, beyond = np.roll(here, -1), np.roll(there, -1)
        if k % 2 == 0:
            triangles += [np.stack([here, there, after], 1), np.stack([after, there, beyond], 1)]
        else:
            triangles += [np.stack([here, there, beyond], 1), np.stack([here, beyond, after], 1)]
    vertices = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(len(angle))], axis=1)
    return TriangleMesh(vertices, np.concatenate(triangles))


def plate_with_window(n: int, margin: int = 3) -> TriangleMesh:
    """Build a flat square of n x n vertices, one unit apart, of which a frame `margin` cells wide is left."""
    whole = open_grid(n)
    middle = np.abs(whole.vertices[whole.triangles].mean(axis=1)).max(axis=1)
    return TriangleMesh(whole.vertices, whole.triangles[middle > (n - 1) / 2 - margin])


def moved(mesh: TriangleMesh, shift: tuple[float, float, float]) -> TriangleMesh:
    """Shift a mesh."""
    return TriangleMesh(mesh.vertices + np.array(shift), mesh.triangles)


def flipped(mesh: TriangleMesh) -> TriangleMesh:
    """Turn a mesh inside out."""
    return TriangleMesh(mesh.vertices, np.ascontiguousarray(mesh.triangles[:, ::-1]))


def random_rotation(rng: np.random.Generator) -> FloatArray:
    """Draw a rotation matrix (3, 3)."""
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return np.asarray(q * np.sign(np.linalg.det(q)))


def has_a_face(mesh: TriangleMesh) -> bool:
    """Whether a face has its three corners in three places."""
    corners = mesh.vertices[mesh.triangles]
    differs = (corners != np.roll(corners, 1, axis=1)).any(axis=2)
    return bool(differs.all(axis=1).any())


def faces_per_edge(triangles: IntArray) -> IntArray:
    """Count the faces of every undirected edge, (n_edges,)."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    return np.asarray(np.unique(edges, axis=0, return_counts=True)[1])


def is_oriented_manifold(triangles: IntArray) -> bool:
    """Whether no edge has more than two faces, and two faces pass their common edge in opposite directions."""
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    passed_once = len(np.unique(edges, axis=0)) == len(edges)
    return bool(passed_once and (faces_per_edge(triangles) <= 2).all())


def euler_characteristic(triangles: IntArray) -> int:
    """Vertices minus edges plus faces, of what the triangles use."""
    return len(np.unique(triangles)) - len(faces_per_edge(triangles)) + len(triangles)


def write_ply(path: Path, mesh: TriangleMesh, number: str = "f8") -> Path:
    """Write a binary PLY with coordinates of type `f4` or `f8`."""
    name = {"f4": "float", "f8": "double"}[number]
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(mesh.vertices)}"]
    lines += [f"property {name} {axis}" for axis in "xyz"]
    lines += [f"element face {len(mesh.triangles)}", "property list uchar int vertex_indices", "end_header", ""]
    faces = np.zeros(len(mesh.triangles), [("n", "u1"), ("corners", "<i4", 3)])
    faces["n"], faces["corners"] = 3, mesh.triangles
    path.write_bytes("\n".join(lines).encode() + mesh.vertices.astype(f"<{number}").tobytes() + faces.tobytes())
    return path
