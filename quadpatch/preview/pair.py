"""A mesh before and after its repair, ready to be drawn."""

from dataclasses import dataclass

import numpy as np

from quadpatch.errors import EmptyMeshError
from quadpatch.mesh.normals import area_vectors
from quadpatch.mesh.raycast import Places, RayScene
from quadpatch.preview.camera import Camera, View
from quadpatch.preview.invented import TINT, Invented
from quadpatch.preview.parts import Part, main_pieces, part_of, touching
from quadpatch.preview.sampling import Colours, sampled
from quadpatch.preview.shading import CLAY, Clay
from quadpatch.preview.viewpoints import is_inside_out
from quadpatch.types import BoolArray, FloatArray, TriangleMesh


@dataclass(frozen=True)
class Pair:
    """Two states of a mesh.

    Attributes
    ----------
    scene : RayScene
        Of the mesh afterwards.
    after : TriangleMesh
        Turned so that its outside is seen from outside.
    whole : Part
        Of `after`, all but stray bits.
    is_flipped : bool
        Whether that took turning it inside out.
    old, new : Clay
        The mesh before and afterwards.
    differs : (n_triangles of `after` + 1,) bool
        False for triangles where the mesh before looks the same; the last one is for places where there is none.
    """

    scene: RayScene
    after: TriangleMesh
    whole: Part
    is_flipped: bool
    old: Clay
    new: Clay
    differs: BoolArray

    def draw(self, camera: Camera, size: tuple[int, int]) -> tuple[Colours, Colours]:
        """Draw both in pictures (rows, columns, 3) of `size` (columns, rows), in pixels."""
        view = View(camera, size)
        before, after = sampled(lambda places: self._colours_at(view, places), size)
        return before, after

    def _colours_at(self, view: View, places: Places) -> Colours:
        triangle = self.new.seen_at(view, places)
        after = self.new.shaded(view, places, triangle)
        both = np.stack([after, after])
        # The number -1 stands for no triangle, and takes the last one.
        again = np.flatnonzero(self.differs[triangle])
        both[0][:, again] = self.old.shaded(view, places[:, again], self.old.seen_at(view, places[:, again]))
        return both


def filled_pair(after: TriangleMesh, invented: Invented) -> Pair:
    """Make a repaired mesh ready to be drawn, beside what was measured of it.

    Parameters
    ----------
    after : TriangleMesh
        Triangles that touch share their vertices.
    invented : Invented
        What the mesh before is without, and what is tinted afterwards.

    Raises
    ------
    EmptyMeshError
        If there is no triangle of any area.
    """
    scene, whole, is_flipped = _surveyed(after)
    after = _flipped(after) if is_flipped else after
    new = Clay(after, scene, invented.colours(), is_joined=True)
    # Along the rim of a hole, the normals of measured triangles are others.
    differs = np.append(touching(after, invented.mask), False)
    return Pair(scene, after, whole, is_flipped, new.without(invented.mask), new, differs)


def moved_pair(
    before: TriangleMesh, after: TriangleMesh, change: BoolArray | FloatArray, *, is_joined: bool = False
) -> Pair:
    """Make a mesh before and after a task ready to be drawn.

    Parameters
    ----------
    before, after : TriangleMesh
        In the same place.
    change : (n_triangles of `after`,) bool or float64
        What is tinted; 0..1 for how strongly.
    is_joined : bool
        See `quadpatch.preview.shading.Clay`.

    Raises
    ------
    EmptyMeshError
        If `after` has no triangle of any area.
    """
    scene, whole, is_flipped = _surveyed(after)
    if is_flipped:
        before, after = _flipped(before), _flipped(after)
    old = Clay(before, RayScene(before), np.tile(CLAY, (len(before.triangles), 1)), is_joined=is_joined)
    share = change.astype(np.float64)[:, None]
    new = Clay(after, scene, (1 - share) * CLAY + share * TINT, is_joined=is_joined)
    return Pair(scene, after, whole, is_flipped, old, new, np.ones(len(after.triangles) + 1, dtype=bool))


def _surveyed(mesh: TriangleMesh) -> tuple[RayScene, Part, bool]:
    """Give the scene of a mesh, all of it but stray bits turned to the outside, and whether that took turning it."""
    if not area_vectors(mesh.vertices, mesh.triangles).any():
        raise EmptyMeshError("there is no surface to draw")
    scene, whole = RayScene(mesh), part_of(mesh, main_pieces(mesh))
    is_flipped = is_inside_out(scene, whole)
    return scene, whole.flipped() if is_flipped else whole, is_flipped


def _flipped(mesh: TriangleMesh) -> TriangleMesh:
    return TriangleMesh(mesh.vertices, mesh.triangles[:, ::-1])
