"""Texture pages: charts laid out with gutters, and painted with the colours of surface samples."""

from dataclasses import dataclass
from io import BytesIO

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.ndimage import distance_transform_edt

from quadpatch.textures.charts import Charts, divide_into_charts, flatten
from quadpatch.textures.packing import Packing, pack
from quadpatch.textures.raster import rasterise
from quadpatch.types import FloatArray, IntArray, Triangles, Vertices

# Sides of a page are powers of two, at most this one.
LARGEST_PAGE = 4096
# Texels around each chart that go on with its colours: filters and smaller copies of the page mix neighbours.
GUTTER = 4
# Where charts don't fit into the largest page, all are made smaller by this factor, again and again.
_SMALLER = 0.85
# A chart that overlaps itself is halved; after so many times it stays as it is.
_MOST_HALVINGS = 12


@dataclass(frozen=True)
class Layout:
    """Where new triangles lie in a page.

    Attributes
    ----------
    width, height : int
        In texels; powers of two.
    corners : (l, 3, 2) float64
        Column and row of the corners of each triangle, in texels from the upper left.
    n_charts : int
    """

    width: int
    height: int
    corners: FloatArray
    n_charts: int

    @property
    def coordinates(self) -> FloatArray:
        """Texture coordinates (l, 3, 2), v upwards."""
        scaled = self.corners / np.array([self.width, self.height])
        return np.stack([scaled[..., 0], 1.0 - scaled[..., 1]], axis=-1)


def lay_out(vertices: Vertices, triangles: Triangles, hole: IntArray, texels_per_unit: FloatArray) -> Layout:
    """Find a place in a page for each triangle of some fills.

    Parameters
    ----------
    vertices : (n, 3) float64
    triangles : (l, 3) int64
        One at least.
    hole : (l,) int64
    texels_per_unit : (n_holes,) float64
        How large each hole is drawn, unless the page gets too large.
    """
    charts = divide_into_charts(vertices, triangles, hole)
    # Loops over halvings.
    for _ in range(_MOST_HALVINGS):
        layout = _packed(
            flatten(vertices, triangles, charts) * texels_per_unit[hole][:, np.newaxis, np.newaxis], charts
        )
        crowded = _overlapping(layout, charts)
        if not len(crowded):
            break
        charts = charts.halved(vertices, triangles, crowded)
    return layout


def _packed(corners: FloatArray, charts: Charts) -> Layout:
    """Lay charts (l, 3, 2), in texels, side by side."""
    # Rows of an image run downwards.
    corners = corners * np.array([1.0, -1.0])
    # Loops over sizes.
    while True:
        low, high = np.full((len(charts), 2), np.inf), np.full((len(charts), 2), -np.inf)
        of_corner = np.repeat(charts.of_triangle, 3)
        np.minimum.at(low, of_corner, corners.reshape(-1, 2))
        np.maximum.at(high, of_corner, corners.reshape(-1, 2))
        sizes = np.ceil(high - low).astype(np.int64) + 1 + 2 * GUTTER
        packing: Packing | None = pack(sizes, LARGEST_PAGE)
        if packing is not None:
            break
        corners = corners * _SMALLER
    shift = packing.corners + GUTTER + 0.5 - low
    return Layout(packing.width, packing.height, corners + shift[charts.of_triangle][:, np.newaxis], len(charts))


def _overlapping(layout: Layout, charts: Charts) -> IntArray:
    """Charts (k,) two of whose triangles cover the middle of the same texel, not on a common edge."""
    owner = np.full(layout.width * layout.height, -1)
    found: list[IntArray] = []
    for covered in rasterise(layout.corners):
        inner = (covered.weights > 1e-6).all(axis=1)
        texel = (covered.row * layout.width + covered.column)[inner]
        taken = owner[texel] >= 0
        texels, first = np.unique(texel, return_index=True)
        is_first = np.zeros(len(texel), bool)
        is_first[first] = True
        found.append(charts.of_triangle[covered.triangle[inner]][taken | ~is_first])
        owner[texels] = 1
    return np.unique(np.concatenate(found))


def paint(layout: Layout, corners: FloatArray, triangles: Triangles, colours: FloatArray) -> bytes:
    """Paint a page.

    Parameters
    ----------
    layout : Layout
    corners : (m, 3, 2) float64
        Column and row of the corners of the triangles of samples, in texels.
    triangles : (m, 3) int64
    colours : (n, 3 or 4) float64
        Of the samples, 0..255.

    Returns
    -------
    bytes
        A PNG.
    """
    n_channels = colours.shape[1]
    page = np.zeros((layout.height, layout.width, n_channels), np.uint8)
    is_painted = np.zeros((layout.height, layout.width), bool)
    for covered in rasterise(corners):
        painted = colours[triangles[covered.triangle, covered.weights.argmax(axis=1)]]
        page[covered.row, covered.column] = np.rint(painted).astype(np.uint8)
        is_painted[covered.row, covered.column] = True
    _spread(page, is_painted)
    encoded = BytesIO()
    Image.fromarray(page).save(encoded, format="PNG")
    return encoded.getvalue()


def _spread(page: NDArray[np.uint8], is_painted: NDArray[np.bool_]) -> None:
    """Carry the colours of charts on over the gutters around them; what lies beyond gets the mean colour."""
    if not is_painted.any():
        return
    distance, (row, column) = distance_transform_edt(~is_painted, return_indices=True)
    is_gutter = ~is_painted & (distance <= GUTTER + 1)
    page[~is_painted & ~is_gutter] = np.rint(page[is_painted].mean(axis=0)).astype(np.uint8)
    page[is_gutter] = page[row[is_gutter], column[is_gutter]]
