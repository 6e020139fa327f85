"""A mesh before and after its repair, ready to be drawn."""

from dataclasses import dataclass

import numpy as np

from quadpatch.errors import EmptyMeshError
from quadpatch.mesh.normals import area_vectors
from quadpatch.mesh.raycast import RayScene
from quadpatch.preview.parts import main_pieces, part_of
from quadpatch.preview.shading import CLAY, Clay
from quadpatch.preview.viewpoints import is_inside_out
from quadpatch.types import BoolArray, FloatArray, TriangleMesh

# What was invented with full confidence, and with none.
SURE = np.array([0.98, 0.74, 0.42])
UNSURE = np.array([0.89, 0.38, 0.30])


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
    before: TriangleMesh, after: TriangleMesh, invented: BoolArray, confidence: FloatArray | None = None
) -> Pair:
    """Make a mesh before and after its repair ready to be drawn.

    Parameters
    ----------
    before, after : TriangleMesh
        In the same place.
    invented : (n_triangles of `after`,) bool
    confidence : (n_triangles of `after`,) float64, optional
        0..1; the less, the redder the tint.

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
    old = Clay(before, RayScene(before), np.tile(CLAY, (len(before.triangles), 1)))
    return Pair(scene, after, is_flipped, old, Clay(after, scene, _colours(invented, confidence)))


def _flipped(mesh: TriangleMesh) -> TriangleMesh:
    return TriangleMesh(mesh.vertices, mesh.triangles[:, ::-1])


def _colours(invented: BoolArray, confidence: FloatArray | None) -> FloatArray:
    sure = np.ones(len(invented)) if confidence is None else np.clip(confidence, 0.0, 1.0)
    tint = UNSURE + sure[:, None] * (SURE - UNSURE)
    return np.where(invented[:, None], tint, CLAY)
