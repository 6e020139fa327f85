"""Rims that bridges join, put among those of the holes: with the islands that lie in the gaps.

Tested in `tests/quadpatch/filling/test_bridges.py`.
"""

import numpy as np

from quadpatch.filling.bridges import Bridge, Refusal
from quadpatch.filling.islands import JoinedRims, loop_around, loop_centres, loop_vector_areas
from quadpatch.mesh.holes import Hole
from quadpatch.mesh.normals import normals_at
from quadpatch.mesh.pieces import find_pieces
from quadpatch.types import FloatArray, TriangleMesh


def join_bridges(
    mesh: TriangleMesh, holes: list[Hole], rims: JoinedRims, bridges: list[Bridge], refused: dict[int, Refusal]
) -> JoinedRims:
    """Put the loops around bridges, and around the islands in their gaps, behind those of holes.

    Parameters
    ----------
    mesh : TriangleMesh
        With the ribs of the bridges behind its own surface.
    holes : list of Hole
        All of the mesh, by id.
    rims : JoinedRims
    bridges : list of Bridge
    refused : dict of int to (str, str)
        See `JoinedRims`.
    """
    ends = {hole.id for bridge in bridges for hole in bridge.holes}
    host_of, loops = dict(rims.host_of), list(rims.loops)
    boxes = np.array([(hole.low, hole.high) for hole in holes]) if bridges else np.zeros((0, 2, 3))
    for bridge in bridges:
        near = [holes[i] for i in _near(mesh, boxes, bridge)]
        islands = [hole for hole in _loops_between(mesh, near, bridge) if hole.id not in ends | host_of.keys()]
        host_of |= {hole.id: bridge.holes[0].id for hole in islands}
        loops.append(loop_around(mesh.vertices, bridge.loop, [hole.loop for hole in islands]))
    firsts = [bridge.holes[0] for bridge in bridges]
    by_first = {bridge.holes[0].id: bridge for bridge in bridges}
    return JoinedRims(loops, [*rims.chosen, *firsts], host_of, by_first, refused)


def _near(mesh: TriangleMesh, boxes: FloatArray, bridge: Bridge) -> list[int]:
    """Find the loops whose boxes (n, 2, 3) lie in the box around a bridge, its own among them."""
    points = mesh.vertices[bridge.loop]
    low, high = points.min(axis=0) - bridge.gap, points.max(axis=0) + bridge.gap
    inside = (boxes[:, 0] >= low).all(axis=1) & (boxes[:, 1] <= high).all(axis=1)
    return np.flatnonzero(inside).tolist()


def _loops_between(mesh: TriangleMesh, near: list[Hole], bridge: Bridge) -> list[Hole]:
    """Find the borders of loose pieces that lie in the gap of a bridge, among some loops."""
    piece = find_pieces(mesh, []).of_vertex
    own = [piece[hole.loop[0]] for hole in bridge.holes]
    found = []
    for hole in (hole for hole in near if hole.is_manifold and piece[hole.loop[0]] not in own):
        normals = normals_at(mesh.vertices, mesh.triangles, hole.loop)
        area = loop_vector_areas(mesh.vertices, [hole.loop], loop_centres(mesh.vertices, [hole.loop]))[0]
        # The border of an island runs counter-clockwise around its surface.
        if area @ normals.mean(axis=0) > 0 and bridge.has_between(mesh.vertices[hole.loop], normals):
            found.append(hole)
    return found
