"""What of a mesh was invented, and the colours that tell it from what was measured."""

from dataclasses import dataclass, replace

import numpy as np

from quadpatch.mesh.averages import mean_by
from quadpatch.mesh.topology import compacted, components, directed_edges, edge_keys
from quadpatch.preview.parts import Part
from quadpatch.preview.shading import CLAY
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh

# Of invented surface, and from a confidence of 0 to one of 1. All can be told apart by people who see no red or green.
TINT = np.array([0.98, 0.74, 0.42])
UNSURE, SURE = np.array([0.93, 0.42, 0.20]), np.array([0.36, 0.60, 0.90])
# Where the confidence is not known.
_UNKNOWN = np.array([0.62, 0.52, 0.62])


@dataclass(frozen=True)
class Invented:
    """The invented triangles of a mesh.

    Attributes
    ----------
    hole : (n_triangles,) int64
        Id of the hole that each one fills; -1 for measured ones.
    confidence : (n_triangles,) float64, optional
        0 to 1, NaN where it is not known. Without, invented surface has one colour.
    is_numbered : bool
        Whether ids mean something to the viewer.
    """

    hole: IntArray
    confidence: FloatArray | None = None
    is_numbered: bool = True

    @classmethod
    def of_mask(cls, invented: BoolArray) -> "Invented":
        """Take what is known of triangles (n_triangles,) alone."""
        return cls(np.where(invented, 0, -1), is_numbered=False)

    @property
    def mask(self) -> BoolArray:
        """(n_triangles,) bool, True = invented."""
        return np.asarray(self.hole >= 0)

    def of(self, kept: IntArray) -> "Invented":
        """Take some triangles (k,)."""
        return replace(
            self, hole=self.hole[kept], confidence=None if self.confidence is None else self.confidence[kept]
        )

    def colours(self) -> FloatArray:
        """Colours (n_triangles, 3) of the mesh, 0..1."""
        tint = np.tile(TINT, (len(self.hole), 1)) if self.confidence is None else confidence_colours(self.confidence)
        return np.where(self.mask[:, None], tint, CLAY)


def confidence_colours(confidence: FloatArray) -> FloatArray:
    """Colours (n, 3) of confidences (n,) of 0..1, or NaN."""
    share = np.nan_to_num(confidence)[:, None]
    return np.where(np.isnan(confidence)[:, None], _UNKNOWN, (1 - share) * UNSURE + share * SURE)


def spanned_rims(mesh: TriangleMesh, invented: BoolArray) -> Part:
    """Span the rims of filled holes by triangles from their middles: what a view is chosen by, whatever fills them."""
    n = max(len(mesh.vertices), 1)
    edges = directed_edges(mesh.triangles[invented])
    measured = edge_keys(directed_edges(mesh.triangles[~invented]), n)
    edges = edges[np.isin(edge_keys(edges, n), measured)]
    used, local = compacted(edges, n)
    rim = components(local, len(used))[local[:, 0]]
    start, end = mesh.vertices[edges[:, 0]], mesh.vertices[edges[:, 1]]
    n_rims = int(rim.max(initial=-1)) + 1
    middle = np.stack([mean_by(rim, start[:, axis], n_rims) for axis in range(3)], axis=1)[rim]
    return Part(mesh.vertices[used], (start + end + middle) / 3, np.cross(start - middle, end - middle))
