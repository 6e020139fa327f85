"""What a boundary loop is: a hole, a slit, the open end of a piece, or its outer border.

The vector area of a loop tells an outer border from a hole, but says nothing of a loop that encloses hardly any area,
and at the end of a tube the normals it is compared with cancel out. So slits and open ends are recognised first, by the
faces along the rim.
"""

import numpy as np

from quadpatch.mesh.loop_diameter import hull_corners
from quadpatch.mesh.loop_shapes import LoopShapes
from quadpatch.mesh.pieces import Pieces
from quadpatch.mesh.rims import Rims
from quadpatch.mesh.slits import slits
from quadpatch.types import BoolArray, FloatArray, IntArray, Vertices
from quadpatch_rules.hole_selection import HoleKind

# The longest loop of a piece is its outer border, if wider than this share of the piece's own diagonal.
BORDER_SHARE = 0.5

# A smaller loop is no border of its piece, whatever the faces at its rim say: on crumpled scans, holes of a few edges
# seem to run around surface. Whether such a hole can be filled, the check of its fill tells.
LEAST_BORDER_SHARE = 0.05

# A loop with the surface on its left runs clockwise around a hole and counter-clockwise around an outer border, seen
# along the normals at its rim; beyond this cosine it is a border for sure, below its opposite a hole.
OUTWARD = 0.5

# A circle has a roundness of 1, a strip of 1 to 15 one of 0.18. Below this, a border is recognised by its length alone:
# a ragged hole where thin surface folds had 0.15 and a cosine over 0.5.
LEAST_ROUNDNESS = 0.2

# Below this, the vector area is what noise left of it.
NO_ROUNDNESS = 0.01

# An open end is planar: root mean square distance from its plane, in diameters. Noise of 1 % at the end of a scanned
# tube gives 0.01, a base cut along the edges of a coarse mesh 0.013; the flattest of 4,420 holes punched into eleven
# scans that passes the other two tests has 0.026.
END_PLANARITY = 0.02

# The faces at its rim rise from that plane at 45 degrees or more: a sphere that is cut at its radius times 0.7 or more.
END_STEEPNESS = 0.7

# And its piece lies on one side of the plane, but for this share of the diameter: noise of 1 % reaches out to 0.04.
END_BEYOND = 0.05

# Pieces with more planar and steep rims than this are reduced to their convex hulls before they are compared with each.
_MANY_RIMS = 16


def hole_kinds(
    vertices: Vertices, rims: Rims, shapes: LoopShapes, pieces: Pieces, is_manifold: BoolArray
) -> list[HoleKind]:
    """Tell the kinds of all loops.

    Parameters
    ----------
    vertices : (n_vertices, 3) float64
    rims : Rims
        Longest perimeter first.
    shapes : LoopShapes
    pieces : Pieces
        With the piece of every loop.
    is_manifold : (n_loops,) bool
        Other loops have no faces that could be relied on: they are borders or holes.
    """
    is_slit = slits(rims, shapes, is_manifold)
    is_end = open_ends(vertices, rims, shapes, pieces, is_manifold & ~is_slit)
    is_border = outer_borders(shapes, pieces, ~is_slit)
    kinds: list[HoleKind] = []
    for slit, end, border in zip(is_slit.tolist(), is_end.tolist(), is_border.tolist(), strict=True):
        kinds.append("slit" if slit else "open_end" if end else "border" if border else "hole")
    return kinds


def outer_borders(shapes: LoopShapes, pieces: Pieces, candidates: BoolArray) -> BoolArray:
    """Find loops (n,) that run around a piece, not around a hole in it."""
    outward = _outwardness(shapes)
    around = candidates & (outward > OUTWARD)
    is_wide = shapes.diameters > BORDER_SHARE * pieces.diagonals[pieces.of_loop]
    # A ragged hole may have a longer rim than the border of its piece.
    has_border = np.zeros(len(pieces.diagonals), bool)
    has_border[pieces.of_loop[around & is_wide]] = True
    eligible = np.flatnonzero(candidates & ~((outward < -OUTWARD) & has_border[pieces.of_loop]))
    longest = eligible[np.unique(pieces.of_loop[eligible], return_index=True)[1]]
    is_large = shapes.diameters > LEAST_BORDER_SHARE * pieces.diagonals[pieces.of_loop]
    is_border = around & is_large & (shapes.roundness >= LEAST_ROUNDNESS)
    is_border[longest] |= is_wide[longest]
    return is_border


def _outwardness(shapes: LoopShapes) -> FloatArray:
    """Mean cosine (n,) between vector area and normals at the rim: 1 a border, -1 a hole, 0 where it says nothing."""
    size = np.linalg.norm(shapes.vector_areas, axis=1)
    # Not divided by the length of the mean normal: at the end of a tube the normals cancel out, and that says nothing.
    cosine = np.einsum("ij,ij->i", shapes.vector_areas, shapes.rim_normals) / np.maximum(size, 1e-300)
    return np.where(shapes.roundness >= NO_ROUNDNESS, cosine, 0.0)


def open_ends(vertices: Vertices, rims: Rims, shapes: LoopShapes, pieces: Pieces, candidates: BoolArray) -> BoolArray:
    """Find loops (n,) that end their piece in a plane: ends of tubes, cut-off bases."""
    rise = _rise(rims, shapes)
    likely = np.flatnonzero(candidates & (shapes.planarity <= END_PLANARITY) & (np.abs(rise) >= END_STEEPNESS))
    found = np.zeros(rims.n_loops, bool)
    of_piece: IntArray = pieces.of_loop[likely]
    for piece in np.unique(of_piece).tolist():
        members = likely[of_piece == piece]
        points = vertices[pieces.vertices_of(piece)]
        if len(members) > _MANY_RIMS:
            points = hull_corners(points)
        for loop in members.tolist():
            upward = shapes.plane_normals[loop] * np.sign(rise[loop])
            beyond = -float(((points - shapes.centres[loop]) @ upward).min())
            found[loop] = beyond <= END_BEYOND * shapes.diameters[loop]
    return found


def _rise(rims: Rims, shapes: LoopShapes) -> FloatArray:
    """Sine (n_loops,) of the angle at which the faces along each rim rise from its plane, signed like its normal.

    Heights are summed before they are divided: noise as large as the faces themselves averages out. What lies in the
    plane is summed by quarters of the rim, or a flap that hangs into the hole would make up for the faces opposite.
    """
    normals, centres = shapes.plane_normals[rims.loop], shapes.centres[rims.loop]
    into = rims.inward * (rims.heights * rims.lengths)[:, None]
    outward = rims.points + rims.edges / 2 - centres
    outward -= np.einsum("ij,ij->i", outward, normals)[:, None] * normals
    outward /= np.maximum(np.linalg.norm(outward, axis=1, keepdims=True), 1e-300)
    up = rims.sums(np.einsum("ij,ij->i", into, normals))
    out = np.abs(_sums_of_quarters(rims, np.einsum("ij,ij->i", into, outward))).sum(axis=1)
    return np.asarray(up / np.maximum(np.hypot(up, out), 1e-300))


def _sums_of_quarters(rims: Rims, values: FloatArray) -> FloatArray:
    """Sum values (n,) over the edges of each quarter of each loop: (n_loops, 4)."""
    position = np.arange(len(rims.loop)) - rims.starts[rims.loop]
    quarter = 4 * position // np.diff(rims.starts)[rims.loop]
    sums = np.bincount(4 * rims.loop + quarter, values, minlength=4 * rims.n_loops)
    return np.asarray(sums, np.float64).reshape(-1, 4)
