"""Connected pieces of a mesh."""

import itertools
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from quadpatch.mesh.passes import extent, parts_of
from quadpatch.mesh.topology import components
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles

Runs = NDArray[np.int32]

# Triangles that are looked at together: what is made of them fits into the processor's cache.
_CHUNK = 1 << 14
# Runs of vertices that are measured one by one: a step of Python each, and fast ones over long runs.
_FEW_RUNS = 1000


@dataclass(frozen=True)
class Pieces:
    """Which piece each vertex and each loop belongs to.

    Attributes
    ----------
    of_vertex : (n_vertices,) int64
    of_loop : (n_loops,) int64
    diagonals : (n_pieces,) float64
        Of the bounding box of each piece, in mesh units.
    """

    of_vertex: IntArray
    of_loop: IntArray
    diagonals: FloatArray

    @cached_property
    def _by_piece(self) -> tuple[IntArray, IntArray]:
        order = np.argsort(self.of_vertex, kind="stable")
        return order, np.searchsorted(self.of_vertex[order], np.arange(len(self.diagonals) + 1))

    def vertices_of(self, piece: int) -> IntArray:
        """Return the vertices (n,) of one piece."""
        order, starts = self._by_piece
        return order[starts[piece] : starts[piece + 1]]


def find_pieces(mesh: TriangleMesh, loops: list[IntArray]) -> Pieces:
    """Find the connected pieces of a mesh, and those of some non-empty loops of vertices."""
    piece = _pieces_of_vertices(mesh.triangles, len(mesh.vertices))
    count = int(piece.max(initial=-1)) + 1
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    # Neighbours in the file are neighbours in a piece, mostly: each such run is one step.
    starts = np.append(np.flatnonzero(np.diff(piece, prepend=-1)), len(piece))
    if len(starts) <= _FEW_RUNS:
        for start, end in itertools.pairwise(starts.tolist()):
            lowest, highest = extent(mesh.vertices[start:end])
            low[piece[start]] = np.minimum(low[piece[start]], lowest)
            high[piece[start]] = np.maximum(high[piece[start]], highest)
    else:
        starts = starts[:-1]
        np.minimum.at(low, piece[starts], np.minimum.reduceat(mesh.vertices, starts, axis=0))
        np.maximum.at(high, piece[starts], np.maximum.reduceat(mesh.vertices, starts, axis=0))
    of_loop = piece[np.array([loop[0] for loop in loops], np.int64)]
    return Pieces(piece, of_loop, np.linalg.norm(high - low, axis=1))


def _pieces_of_vertices(triangles: Triangles, n_vertices: int) -> IntArray:
    """Find the piece of each vertex, (n_vertices,) int64, counted from 0.

    Scanners write row by row: most vertices have an edge to the next one. Such runs are joined first, which leaves
    little to search in.
    """
    has_edge_to_next = np.zeros(n_vertices, bool)
    for part in parts_of(len(triangles), _CHUNK):
        a, b, c = triangles[part].T
        for start, end in ((a, b), (b, c)):
            step = end - start
            has_edge_to_next[start[step == 1]] = True
            has_edge_to_next[end[step == -1]] = True
    run = np.zeros(n_vertices, np.int32)
    np.cumsum(~has_edge_to_next[:-1], out=run[1:])
    n_runs = int(run[-1]) + 1 if n_vertices else 0
    links = [np.zeros((0, 2), np.int32)]
    for part in parts_of(len(triangles), _CHUNK):
        a, b, c = (run[column] for column in triangles[part].T)
        links += [_links(a, b), _links(b, c)]
    return np.asarray(components(np.concatenate(links), n_runs)[run])


def _links(one: Runs, other: Runs) -> Runs:
    """Pairs (k, 2) of runs that differ, without most of their repetitions."""
    wanted = one != other
    wanted[1:] &= (one[1:] != one[:-1]) | (other[1:] != other[:-1])
    return np.stack([one[wanted], other[wanted]], axis=1)
