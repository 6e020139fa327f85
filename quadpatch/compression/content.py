"""What a `.qpz` file says, as arrays of whole numbers and a few lengths.

Tested in `tests/quadpatch/compression/test_qpz_file.py`.
"""

from dataclasses import dataclass, field
from typing import Final, Literal, get_args

import numpy as np

from quadpatch.compression.connectivity import Walk
from quadpatch.compression.patch_dictionary import EmbeddedAtoms
from quadpatch.types import IntArray

DictionaryKind = Literal["cosine", "self", "model"]
COSINE: Final = "cosine"
SELF: Final = "self"
MODEL: Final = "model"
# In the order of their numbers in a file.
DICTIONARY_KINDS: tuple[DictionaryKind, ...] = get_args(DictionaryKind)


def _none() -> IntArray:
    return np.zeros(0, np.int64)


def _no_places() -> IntArray:
    return np.zeros((0, 3), np.int64)


@dataclass(frozen=True)
class DictionaryReference:
    """Which dictionary the codes are over.

    Attributes
    ----------
    kind : str
        `cosine`: products of cosines, which need no reference; `self`: it stands in the file; `model`: a model file.
    name : str
        Of a model, as `name@version`.
    sha256 : bytes
        32 bytes, of a model's file.
    """

    kind: DictionaryKind
    name: str = ""
    sha256: bytes = b""


@dataclass(frozen=True)
class Lengths:
    """Lengths of a file, in mesh units.

    Attributes
    ----------
    max_error : float
        What is promised.
    origin : (3,) float
        Where the lattices start.
    place_step : float
        Of the quad mesh's vertices.
    code_step : float
        Of the coefficients.
    """

    max_error: float
    origin: tuple[float, float, float]
    place_step: float
    code_step: float


@dataclass(frozen=True)
class Pieces:
    """Surface that is no height map over the quads: triangles in the order of a walk, vertices on a lattice."""

    walk: Walk = field(default_factory=Walk)
    places: IntArray = field(default_factory=_no_places)


@dataclass(frozen=True)
class KeptVertices:
    """The vertices and triangles of the mesh itself.

    Attributes
    ----------
    triangles : (n_triangles, 3) int64
        As in the file that was encoded.
    patch : (n_vertices,) int64
        Patch that a vertex lies on, or the number of patches for one that lies on none.
    place : (n_vertices, 3) int64
        Column and row on the patch in parts of a cell, and height over the decoded surface in steps; for a vertex on no
        patch its place on the lattice.
    """

    triangles: IntArray
    patch: IntArray
    place: IntArray


@dataclass(frozen=True)
class QpzContent:
    """Everything that a file says.

    Attributes
    ----------
    lengths : Lengths
    unit : str
        Length unit; empty where the mesh states none.
    levels : int
        Every quad becomes a grid of 2**levels cells along each side.
    dictionary : DictionaryReference
    embedded : EmbeddedAtoms or None
        Where the dictionary stands in the file.
    walk : Walk
        The quads.
    places : (n, 3) int64
        Vertices of the quad mesh on the lattice.
    codes : (n_quads, n_atoms) int64
    corrected, corrections : (n,) int64
        Grid vertices in ascending order, and how many steps each is moved along its normal.
    removed : (n,) int64
        Cells that are left out, in ascending order.
    border_moves : (n, 3) int64
        How many steps each border vertex of the remaining cells is moved, in ascending order of these vertices.
    pieces : Pieces
    kept : KeptVertices or None
        Where the mesh's own vertices and triangles come back.
    """

    lengths: Lengths
    unit: str
    levels: int
    dictionary: DictionaryReference
    embedded: EmbeddedAtoms | None
    walk: Walk
    places: IntArray
    codes: IntArray
    corrected: IntArray = field(default_factory=_none)
    corrections: IntArray = field(default_factory=_none)
    removed: IntArray = field(default_factory=_none)
    border_moves: IntArray = field(default_factory=_no_places)
    pieces: Pieces = field(default_factory=Pieces)
    kept: KeptVertices | None = None
