"""From the content of a file to its surface.

The order is that of the encoder: the quads' grid, raised by the codes; corrections along the normals; cells left out;
border vertices moved; pieces that are no height map appended.

Tested in `tests/quadpatch/compression/test_encode.py`.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.compression.content import MODEL, SELF, QpzContent
from quadpatch.compression.heights import Grid, make_grid
from quadpatch.compression.lattice import from_lattice
from quadpatch.compression.patch_dictionary import cosine_atoms
from quadpatch.compression.sparse_codes import decoded_heights
from quadpatch.types import BoolArray, FloatArray, IntArray, QuadMesh, TriangleMesh, Triangles, Vertices

# Steps in parts of the promised error. A correction leaves half a step of height, a lattice sqrt(3) / 2.
CORRECTION_STEP = 0.5
MOVE_STEP = 0.6
PIECE_STEP = 1.0


@dataclass(frozen=True)
class DecodedSurface:
    """A surface, and the grid that it was made over.

    Attributes
    ----------
    mesh : TriangleMesh
        Remaining cells, two triangles each, then pieces; no vertex without a triangle.
    grid : Grid
    vertices : (n_grid, 3) float64
        Every grid vertex where it came to lie.
    n_grid_triangles : int
        Triangles of `mesh` that are cells.
    """

    mesh: TriangleMesh
    grid: Grid
    vertices: Vertices
    n_grid_triangles: int


def content_grid(content: QpzContent) -> Grid:
    """Grid of the quads of a file."""
    origin = np.array(content.lengths.origin)
    quads = np.array(content.walk.polygons, np.int64).reshape(-1, 4)
    return make_grid(QuadMesh(from_lattice(content.places, origin, content.lengths.place_step), quads), content.levels)


def content_atoms(content: QpzContent, model_atoms: FloatArray | None) -> FloatArray:
    """Atoms (n_bins, n_atoms) that the codes are over; `model_atoms` where they are those of a model."""
    if content.dictionary.kind == MODEL and model_atoms is not None:
        return model_atoms[:, : content.codes.shape[1]]
    if content.dictionary.kind == SELF and content.embedded is not None:
        return content.embedded.atoms()[:, : content.codes.shape[1]]
    return cosine_atoms(2**content.levels + 1)[:, : content.codes.shape[1]]


def decode_surface(content: QpzContent, atoms: FloatArray, grid: Grid | None = None) -> DecodedSurface:
    """Put the surface of a file together.

    Parameters
    ----------
    content : QpzContent
    atoms : (n_bins, n_atoms) float64
        See `content_atoms`.
    grid : Grid, optional
        That of `content_grid`, where it is at hand.
    """
    grid = grid or content_grid(content)
    step = content.lengths.max_error
    heights = decoded_heights(grid, content.codes, atoms, content.lengths.code_step)
    heights[content.corrected] += CORRECTION_STEP * step * content.corrections
    vertices = grid.raised(heights)
    remains = np.ones(len(grid.triangles) // 2, np.bool_)
    remains[content.removed] = False
    triangles = grid.triangles[np.repeat(remains, 2)]
    if len(content.border_moves):
        vertices[border_vertices(triangles, len(vertices))] += MOVE_STEP * step * content.border_moves
    pieces = np.array(content.pieces.walk.polygons, np.int64).reshape(-1, 3)
    piece_places = from_lattice(content.pieces.places, np.array(content.lengths.origin), PIECE_STEP * step)
    mesh = _compacted(np.concatenate([vertices, piece_places]), np.concatenate([triangles, pieces + len(vertices)]))
    return DecodedSurface(mesh, grid, vertices, len(triangles))


def border_vertices(triangles: Triangles, n_vertices: int) -> IntArray:
    """Vertices at edges of one triangle, in ascending order."""
    ends = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    keys, count = np.unique(ends[:, 0] * np.int64(n_vertices) + ends[:, 1], return_counts=True)
    single = keys[count == 1]
    on_border: BoolArray = np.zeros(n_vertices, np.bool_)
    on_border[single // n_vertices] = True
    on_border[single % n_vertices] = True
    return np.flatnonzero(on_border)


def _compacted(vertices: Vertices, triangles: Triangles) -> TriangleMesh:
    used, compact = np.unique(triangles, return_inverse=True)
    return TriangleMesh(vertices[used], compact.reshape(-1, 3).astype(np.int64))
