"""One way to encode a mesh, and how many bytes it would take.

Tested in `tests/quadpatch/compression/test_encode.py`.
"""

from dataclasses import dataclass, replace

import numpy as np

from quadpatch.compression.connectivity import encode_polygons
from quadpatch.compression.content import (
    COSINE,
    MODEL,
    SELF,
    DictionaryKind,
    DictionaryReference,
    Lengths,
    QpzContent,
)
from quadpatch.compression.control_mesh import collapse_to_quads
from quadpatch.compression.decoded_surface import content_atoms, decode_surface
from quadpatch.compression.guarantee import Target, first_corrections
from quadpatch.compression.heights import make_grid, measure_heights
from quadpatch.compression.lattice import from_lattice, to_lattice
from quadpatch.compression.patch_dictionary import cosine_atoms, learned_atoms, model_atoms
from quadpatch.compression.proof import Samples
from quadpatch.compression.qpz_file import encode_content
from quadpatch.compression.sparse_codes import sparse_codes
from quadpatch.compression.surface_fit import fit_quads
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.measures import mean_edge_length, surface_area
from quadpatch.mesh.raycast import RayScene
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.patches.scale import base_surface_iterations
from quadpatch.quads.mesher import quadrangulate
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.types import FloatArray, QuadMesh, TriangleMesh, Vertices

# Step of the quad mesh's vertices, in parts of the promised error; the codes make up for it.
_PLACE_STEP = 1.0
# Bytes of one triangle where the surfaces are too far apart, for estimates: it takes others with it.
_PIECE_BYTES = 6.0
_MOST_PROBES = 10_000
_LEVELS_RANGE = (2, 5)
# Added to the levels before rounding: a grid that is too coarse costs more than one that is too fine.
_FINER = 0.3
# Grid vertices along one side of the patches that quantisation steps are given for.
_USUAL_SIDE = 9
# Last coefficients that no patch uses are not written.
_FEWEST_ATOMS = 1


@dataclass(frozen=True)
class DictionaryChoice:
    """What codes may be over.

    Attributes
    ----------
    kinds : tuple of str
        `cosine`, `self`, `model`: the one with the smaller file is taken.
    model : Dictionary or None
    reference : DictionaryReference or None
        Of that model.
    """

    kinds: tuple[DictionaryKind, ...]
    model: Dictionary | None = None
    reference: DictionaryReference | None = None


@dataclass(frozen=True)
class Task:
    """What stays the same for all candidates: the mesh, the same with fewer triangles, its samples, what is wanted."""

    mesh: TriangleMesh
    thinned: TriangleMesh
    scene: RayScene
    samples: Samples
    spacing: float
    dictionary: DictionaryChoice
    max_error: float
    keeps_connectivity: bool
    unit: str


@dataclass(frozen=True)
class Candidate:
    """Quads with codes, not yet within the promised error everywhere.

    Attributes
    ----------
    content : QpzContent
        With the first corrections.
    model_atoms : (n_bins, n_atoms) float64 or None
        Of a model's dictionary.
    target : Target
    estimated_bytes : float
    """

    content: QpzContent
    model_atoms: FloatArray | None
    target: Target
    estimated_bytes: float


def make_candidate(task: Task, quads: tuple[int, bool, int | None], fineness: float) -> Candidate:
    """Cover the mesh with quads, and code it.

    Parameters
    ----------
    task : Task
    quads : (int, bool, int or None)
        How many; whether all of one size; levels of their grids, by default such that cells are as many as vertices.
    fineness : float
        See `coded`.

    Raises
    ------
    NoQuadsError
        If no quad comes out.
    """
    n_quads, is_uniform, levels = quads
    rough = _uniform(task.mesh, n_quads) if is_uniform else collapse_to_quads(task.thinned, n_quads)
    fitted = fit_quads(rough, task.thinned)
    walk, _, vertex = encode_polygons(fitted.quads)
    origin = task.mesh.vertices[task.mesh.triangles].reshape(-1, 3).min(axis=0)
    places = to_lattice(fitted.vertices[vertex], origin, _PLACE_STEP * task.max_error)
    quad_mesh = QuadMesh(from_lattice(places, origin, _PLACE_STEP * task.max_error), np.array(walk.polygons, np.int64))
    if levels is None:
        cells = len(task.mesh.vertices) / len(fitted.quads)
        levels = int(np.clip(round(0.5 * np.log2(max(cells, 1.0)) + _FINER), *_LEVELS_RANGE))
    grid = make_grid(quad_mesh, levels)
    heights, known = measure_heights(grid, task.mesh, task.scene, _mean_side(quad_mesh))
    x, y, z = origin.tolist()
    lengths = Lengths(task.max_error, (x, y, z), _PLACE_STEP * task.max_error, task.max_error)
    empty = np.zeros((len(fitted.quads), 0), np.int64)
    content = QpzContent(lengths, task.unit, levels, DictionaryReference(COSINE), None, walk, places, empty)
    target = Target(task.mesh, task.samples, task.spacing, grid, heights, known)
    return coded(task, Candidate(content, None, target, np.inf), fineness)


def coded(task: Task, candidate: Candidate, fineness: float) -> Candidate:
    """Code the heights of a candidate anew, over the dictionary that takes the fewest bytes.

    Parameters
    ----------
    task : Task
    candidate : Candidate
    fineness : float
        Quantisation step in parts of the promised error, for patches of 9 x 9 grid vertices. Over others it grows as
        the coefficients do: with the root of the number of vertices.
    """
    code_step = fineness * task.max_error * (2**candidate.content.levels + 1) / _USUAL_SIDE
    choices = (_coded_over(task, candidate, code_step, kind) for kind in task.dictionary.kinds)
    return min(choices, key=lambda choice: choice.estimated_bytes)


def _coded_over(task: Task, candidate: Candidate, code_step: float, kind: DictionaryKind) -> Candidate:
    target, content = candidate.target, candidate.content
    n_bins = (2**content.levels + 1) ** 2
    embedded, of_model, reference = None, None, DictionaryReference(COSINE)
    if kind == MODEL and task.dictionary.model is not None and task.dictionary.reference is not None:
        of_model, reference = model_atoms(task.dictionary.model, 2**content.levels + 1), task.dictionary.reference
        atoms = of_model
    elif kind == SELF:
        signals = np.where(target.known, target.heights, 0.0)[target.grid.patches].reshape(-1, n_bins)
        embedded, reference = learned_atoms(signals, code_step), DictionaryReference(SELF)
        atoms = embedded.atoms()
    else:
        atoms = cosine_atoms(2**content.levels + 1)
    codes = sparse_codes(target.grid, target.heights, target.known, atoms, code_step)
    used = np.flatnonzero(codes.any(axis=0))
    codes = codes[:, : max(int(used.max(initial=0)) + 1, _FEWEST_ATOMS)]
    content = replace(
        content,
        lengths=replace(content.lengths, code_step=code_step), dictionary=reference, embedded=embedded, codes=codes,
    )  # fmt: skip
    content, _ = first_corrections(content, content_atoms(content, of_model), target)
    return Candidate(content, of_model, target, _estimate(task, content, content_atoms(content, of_model), target))


def _estimate(task: Task, content: QpzContent, atoms: FloatArray, target: Target) -> float:
    """Bytes of the file with its first corrections, and of the triangles where one surface is too far away."""
    n_bytes = float(len(encode_content(content, 0)))
    if task.keeps_connectivity:
        return n_bytes
    decoded = decode_surface(content, atoms, target.grid)
    uncovered = _share_beyond(task.samples.points, decoded.mesh, task.max_error)
    # Grid vertices that see no surface may lie beyond it; the others lie on it but for what is corrected.
    blind = decoded.vertices[~target.known]
    overhang = _share_beyond(blind, task.mesh, task.max_error) * len(blind) / len(decoded.vertices)
    return n_bytes + _PIECE_BYTES * max(uncovered, overhang) * len(task.mesh.triangles)


def _share_beyond(points: Vertices, mesh: TriangleMesh, limit: float) -> float:
    """Share of points, or of some of them, that are farther from a mesh than a limit."""
    if not len(points):
        return 0.0
    probes = points[:: 1 + len(points) // _MOST_PROBES]
    return float((distance_to_mesh(probes, mesh) > limit).mean())


def _uniform(mesh: TriangleMesh, n_quads: int) -> QuadMesh:
    """Quads of one size, as a repair has them."""
    side = float(np.sqrt(surface_area(mesh) / n_quads))
    return quadrangulate(laplacian_smooth(mesh, base_surface_iterations(side, mean_edge_length(mesh))), side)


def _mean_side(quad_mesh: QuadMesh) -> float:
    corners = quad_mesh.vertices[quad_mesh.quads]
    return float(np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).mean())
