"""Reference frames of quads, turned to agree with their neighbours.

A quad has a normal but four equally good directions for x. Patches of neighbouring quads look alike to a dictionary
only if they pick the same one, so the choice is handed on from quad to quad, breadth first. Around an irregular vertex
of the quad mesh it can't close without a jump.

References
----------
K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019, section "Patch
orientation".
"""

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import breadth_first_order

from quadpatch.types import FloatArray, Frames, IntArray, QuadMesh, Quads, Vertices


def quad_frames(quad_mesh: QuadMesh) -> Frames:
    """Give each quad a right-handed orthonormal frame, consistent over shared edges.

    z is the normal of the quad (cross product of its diagonals), x and y run along its sides: of all orthonormal
    pairs in the plane the one closest to the means of opposite sides. Each connected piece starts at its quad of
    lowest index, whose x runs from its first corner to its second; the others follow breadth first.

    Parameters
    ----------
    quad_mesh : QuadMesh
        Quads of non-zero area.

    Returns
    -------
    (n_quads, 3, 3) float64
        Rows x, y, z. Never NaN: a quad without area gets axes in an arbitrary direction.
    """
    frames = _own_frames(quad_mesh.vertices, quad_mesh.quads)
    if len(frames) == 0:
        return frames
    parent = _breadth_first_parents(quad_mesh.quads)
    # Quarter turns of each quad relative to its parent; a root has none.
    turns = np.zeros(len(frames), dtype=np.int64)
    child = np.flatnonzero(parent >= 0)
    turns[child] = _quarter_turns(frames[parent[child]], frames[child])
    return _turned(frames, _summed_from_root(parent, turns))


def quad_normals(vertices: Vertices, quads: Quads) -> FloatArray:
    """Cross product of the diagonals of each quad: along its normal, twice its area long.

    Parameters
    ----------
    vertices : (n_vertices, 3) float64
    quads : (n_quads, 4) int64

    Returns
    -------
    (n_quads, 3) float64
    """
    a, b, c, d = (vertices[quads[:, corner]] for corner in range(4))
    return np.cross(c - a, d - b)


def _own_frames(vertices: Vertices, quads: Quads) -> Frames:
    """Frame of each quad for itself, x along its first side."""
    a, b, c, d = (vertices[quads[:, corner]] for corner in range(4))
    z = _unit(quad_normals(vertices, quads), np.array([0.0, 0.0, 1.0]))
    along_x, along_y = (b - a) + (c - d), (d - a) + (c - b)
    along_x -= np.einsum("ij,ij->i", along_x, z)[:, None] * z
    along_y -= np.einsum("ij,ij->i", along_y, z)[:, None] * z
    # Rotated back by 90 degrees, y is a second opinion on x: the bisector is the closest orthonormal pair.
    opinions = _unit(along_x, np.zeros(3)) + _unit(np.cross(along_y, z), np.zeros(3))
    x = _unit(opinions, np.zeros(3))
    # A quad whose sides vanish or contradict each other has no x of its own; any direction in its plane will do.
    has_none = np.einsum("ij,ij->i", x, x) < 0.5
    axis = np.eye(3)[np.argmin(np.abs(z[has_none]), axis=1)]
    x[has_none] = _unit(np.cross(axis, z[has_none]), np.zeros(3))
    return np.stack([x, np.cross(z, x), z], axis=1)


def _unit(vectors: FloatArray, otherwise: FloatArray) -> FloatArray:
    """Scale to length 1; vectors too short to have a direction become `otherwise`."""
    # Dividing by the largest component first keeps squares of very small or large vectors in range.
    largest = np.abs(vectors).max(axis=1, keepdims=True)
    is_short = ~(largest > np.finfo(np.float64).tiny)
    scaled = np.divide(vectors, largest, out=np.zeros_like(vectors), where=~is_short)
    length = np.linalg.norm(scaled, axis=1, keepdims=True)
    unit = np.divide(scaled, length, out=np.zeros_like(vectors), where=length > 0)
    return np.where(is_short, otherwise, unit)


def _breadth_first_parents(quads: Quads) -> IntArray:
    """Quad from which each one is reached, breadth first; -1 for the first quad of a connected piece."""
    graph = _neighbours(quads)
    parent = np.full(len(quads), -1, dtype=np.int64)
    is_reached = np.zeros(len(quads), dtype=bool)
    # One turn per connected piece, of which there are few.
    while not is_reached.all():
        start = int(np.argmin(is_reached))
        nodes, predecessors = breadth_first_order(graph, start, directed=False)
        parent[nodes] = np.maximum(predecessors[nodes], -1)
        is_reached[nodes] = True
    return parent


def _neighbours(quads: Quads) -> csr_array:
    """Quads that share an edge; an edge of more than two quads links each to the next."""
    n_quads = len(quads)
    ends = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    keys = ends[:, 0] * (int(quads.max()) + 1) + ends[:, 1]
    owner = np.repeat(np.arange(n_quads), 4)
    by_edge = np.argsort(keys, kind="stable")
    is_same = keys[by_edge][1:] == keys[by_edge][:-1]
    one, other = owner[by_edge][:-1][is_same], owner[by_edge][1:][is_same]
    return coo_array((np.ones(len(one)), (one, other)), shape=(n_quads, n_quads)).tocsr()


def _quarter_turns(parents: Frames, children: Frames) -> IntArray:
    """Quarter turns about z that bring the child's x and y together closest to the parent's.

    Both axes count, so that the turn is certain even over a right-angled edge, where one of them vanishes.
    """
    dot = np.einsum("nij,nkj->nik", parents[:, :2], children[:, :2])
    angle = np.arctan2(dot[:, 0, 1] - dot[:, 1, 0], dot[:, 0, 0] + dot[:, 1, 1])
    return np.asarray(np.round(angle / (np.pi / 2)).astype(np.int64) % 4)


def _summed_from_root(parent: IntArray, turns: IntArray) -> IntArray:
    """Sum the turns from the first quad of its piece down to each quad, by doubling the length of the jumps."""
    total = turns.copy()
    jump = parent.copy()
    while (jump >= 0).any():
        below = np.flatnonzero(jump >= 0)
        total[below] += total[jump[below]]
        jump[below] = jump[jump[below]]
    return total % 4


def _turned(frames: Frames, quarter_turns: IntArray) -> Frames:
    x, y = frames[:, 0], frames[:, 1]
    directions = np.stack([x, y, -x, -y])
    rows = np.arange(len(frames))
    return np.stack([directions[quarter_turns, rows], directions[(quarter_turns + 1) % 4, rows], frames[:, 2]], axis=1)
