"""Decodes a `.qpz` file: bytes in, mesh out.

Tested in `tests/quadpatch/compression/test_qpz_file.py`.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from quadpatch.compression.content import MODEL, DictionaryReference, QpzContent
from quadpatch.compression.decoded_surface import border_vertices, content_atoms, content_grid, decode_surface
from quadpatch.compression.heights import Grid
from quadpatch.compression.kept_vertices import kept_positions
from quadpatch.compression.patch_dictionary import model_atoms
from quadpatch.compression.qpz_file import decode_content
from quadpatch.errors import ReadError
from quadpatch.formats.limits import ReadLimits, check_vertices
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.types import FloatArray, TriangleMesh


class FindDictionary(Protocol):
    """Finds the model that a file names, and refuses any other; ModelError where there is none."""

    def __call__(self, reference: DictionaryReference) -> Dictionary:
        """Return its dictionary."""


@dataclass(frozen=True)
class Decoded:
    """What a file gives back.

    Attributes
    ----------
    mesh : TriangleMesh
        The mesh itself where connectivity was kept, else a regular mesh over the quads.
    content : QpzContent
    """

    mesh: TriangleMesh
    content: QpzContent


def decode_mesh(data: bytes, find_dictionary: FindDictionary, limits: ReadLimits | None = None) -> Decoded:
    """Decode the bytes of a file.

    Parameters
    ----------
    data : bytes
        Whatever they are, a MeshError or a mesh comes of them.
    find_dictionary : callable
        Asked where the file names a model.
    limits : ReadLimits, optional
        Held against the counts of the file before memory is taken.

    Raises
    ------
    MeshError
        ReadError, FormatError, TooLargeError, IndexRangeError, NotFiniteError or CoordinateRangeError.
    ModelError
        If the file was written with another dictionary than the one that was found.
    """
    content, parts = decode_content(data, limits or ReadLimits())
    atoms = None
    if content.dictionary.kind == MODEL:
        atoms = model_atoms(find_dictionary(content.dictionary), 2**content.levels + 1)
    used = content_atoms(content, atoms)
    if used.shape[1] != content.codes.shape[1]:
        raise ReadError("the .qpz file has codes for more atoms than its dictionary has")
    grid = content_grid(content)
    _check_places(content, grid)
    with np.errstate(over="ignore", invalid="ignore"):
        decoded = decode_surface(content, used, grid)
        mesh = decoded.mesh
        if content.kept is not None:
            mesh = TriangleMesh(kept_positions(content, content.kept, decoded, parts), content.kept.triangles)
    check_vertices(mesh.vertices)
    return Decoded(mesh, content)


def _check_places(content: QpzContent, grid: Grid) -> None:
    """Refuse grid vertices and cells that are not there, and border moves that do not fit the border."""
    n_cells = len(grid.triangles) // 2
    for name, numbers, limit in (
        ("grid vertex", content.corrected, len(grid.points)),
        ("cell", content.removed, n_cells),
    ):
        if len(numbers) and int(numbers[-1]) >= limit:
            raise ReadError(f"the .qpz file names {name} {int(numbers[-1])} of {limit}")
    if len(content.border_moves):
        remains: FloatArray = np.ones(n_cells, np.bool_)
        remains[content.removed] = False
        border = border_vertices(grid.triangles[np.repeat(remains, 2)], len(grid.points))
        if len(border) != len(content.border_moves):
            raise ReadError(f"the .qpz file moves {len(content.border_moves)} of {len(border)} border vertices")
