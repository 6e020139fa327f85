"""Arrays, named by their role.

Every length is in mesh units unless its name says otherwise (`_bins`, `_s`).

Tested in `tests/quadpatch/patches/test_height_map.py`.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

Vertices = FloatArray  # (n_vertices, 3)
Triangles = IntArray  # (n_triangles, 3), counter-clockwise seen from outside
Quads = IntArray  # (n_quads, 4), counter-clockwise seen from outside
Frames = FloatArray  # (n, 3, 3), rows x, y, z; right-handed; z is the surface normal


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Vertices (n, 3) float64 in mesh units and triangles (m, 3) int64, counter-clockwise seen from outside.

    Its arrays are not written to: what was measured of a mesh is kept with it.
    """

    vertices: Vertices
    triangles: Triangles


@dataclass(frozen=True)
class QuadMesh:
    """Vertices (n, 3) float64 in mesh units and quads (m, 4) int64, counter-clockwise seen from outside."""

    vertices: Vertices
    quads: Quads


@dataclass(frozen=True)
class Patches:
    """Square height-map patches.

    Bin (i, j) of patch p lies at ``origin + x * (j + 0.5 - N / 2) * bin + y * (i + 0.5 - N / 2) * bin`` with
    ``bin = length / N`` and the rows x, y, z of the patch's reference frame; its surface point is that plus
    ``height * z``.

    Attributes
    ----------
    origins : (n_patches, 3) float64
    frames : (n_patches, 3, 3) float64
    length : float
        Side of the square, in mesh units.
    heights : (n_patches, N, N) float64
        In mesh units; 0 where `seen` is False.
    known : (n_patches, N, N) bool
        True = measured bin: the surface there was measured, not invented.
    seen : (n_patches, N, N) bool
        True where a ray hit any surface, measured or invented.
    triangle : (n_patches, N, N) int64
        Triangle that was hit, -1 for none.
    """

    origins: Vertices
    frames: Frames
    length: float
    heights: FloatArray
    known: BoolArray
    seen: BoolArray
    triangle: IntArray

    @property
    def resolution(self) -> int:
        """Bins along one side."""
        return int(self.heights.shape[-1])

    def __len__(self) -> int:
        """Count of patches."""
        return len(self.origins)
