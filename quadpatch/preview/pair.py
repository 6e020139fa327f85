"""A mesh before and after its repair, ready to be drawn.

Tested in `tests/quadpatch/preview/test_sheet.py`.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.errors import EmptyMeshError
from quadpatch.mesh.normals import area_vectors
from quadpatch.mesh.raycast import RayScene
from quadpatch.preview.parts import main_pieces, part_of
from quadpatch.preview.shading import CLAY, Clay
from quadpatch.preview.viewpoints import is_inside_out
from quadpatch.types import BoolArray, FloatArray, TriangleMesh

# Of invented surface.
TINT = np.array([0.98, 0.74, 0.42])


@dataclass(frozen=True)
class Pair:
    """Two states of a mesh.

    Attributes
    ----------
    scene : RayScene
        Of the mesh afterwards.
    after : TriangleMesh
        Turned so that its outside is seen from outside.
    is_flipped : bool
        Whether that took turning it inside out.
    old, new : Clay
        The mesh before and afterwards.
    """

    scene: RayScene
    after: TriangleMesh
    is_flipped: bool
    old: Clay
    new: Clay


def prepare(
    before: TriangleMesh, after: TriangleMesh, invented: BoolArray | FloatArray, *, is_joined: bool = False
) -> Pair:
    """Make a mesh before and after its repair, or another task, ready to be drawn.

    Parameters
    ----------
    before, after : TriangleMesh
        In the same place.
    invented : (n_triangles of `after`,) bool or float64
        What is tinted; 0..1 for how strongly.
    is_joined : bool
        See `quadpatch.preview.shading.Clay`.

    Raises
    ------
    EmptyMeshError
        If `after` has no triangle of any area.
    """
    if not area_vectors(after.vertices, after.triangles).any():
        raise EmptyMeshError("there is no surface to draw")
    scene = RayScene(after)
    is_flipped = is_inside_out(scene, part_of(after, main_pieces(after)))
    if is_flipped:
        before, after = _flipped(before), _flipped(after)
    old = Clay(before, RayScene(before), np.tile(CLAY, (len(before.triangles), 1)), is_joined=is_joined)
    share = invented.astype(np.float64)[:, None]
    new = Clay(after, scene, (1 - share) * CLAY + share * TINT, is_joined=is_joined)
    return Pair(scene, after, is_flipped, old, new)


def _flipped(mesh: TriangleMesh) -> TriangleMesh:
    return TriangleMesh(mesh.vertices, mesh.triangles[:, ::-1])
