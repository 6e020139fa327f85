"""Colours for the new vertices of a filled mesh: the texture of the surroundings is carried on over them."""

from dataclasses import dataclass

import numpy as np

from quadpatch.calibration.calibration_set import MIN_HOLES
from quadpatch.colours.calibration import Detail, Verdict, calibrate
from quadpatch.colours.cells import MARGIN, Cells, cell_radius, divide
from quadpatch.colours.detail import DetailMaker
from quadpatch.colours.exemplars import Lender, cost_of_match, find_matches
from quadpatch.colours.gap_graph import GapGraph
from quadpatch.colours.hidden import hide_disks
from quadpatch.colours.patches import PatchSampler
from quadpatch.colours.surface import ColouredSurface
from quadpatch.colours.surroundings import Surroundings
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.measures import EdgeStatistics
from quadpatch.types import FloatArray, IntArray, TriangleMesh

# Best matches that are kept for each cell. Where many vertices are to be coloured, there are fewer of them: so many
# colours are looked up in all.
_MATCHES = (8, 64)
_LENDING_BUDGET = 3e6
# Sources that cells are compared with. Where there are many cells, there are fewer of them, so that matching takes some
# seconds at most on one core: so many multiplications.
_SOURCES = (64, 512)
_MATCHING_BUDGET = 3e10
# With fewer sources than this, cells and sources of half the size are tried: what was measured is a narrow strip.
_LEAST_FOUND = 32


@dataclass(frozen=True)
class NewColours:
    """Colours of the new vertices of a filled mesh.

    Attributes
    ----------
    colours : (n_new, c) float64 or None
        0..255, NaN where harmonic ones are to stay; None where they are everywhere.
    verdict : Verdict or None
        What calibration says of detail by exemplars; None where there was no room for it.
    """

    colours: FloatArray | None
    verdict: Verdict | None = None

    @property
    def method(self) -> str:
        """`exemplars` or `harmonic`."""
        return "harmonic" if self.colours is None else "exemplars"


def continue_colours(
    filled: FilledMesh, colours: FloatArray, edges: EdgeStatistics, rng: np.random.Generator
) -> NewColours:
    """Carry the texture around holes on over their fills, where calibration says that this is better.

    Parameters
    ----------
    filled : FilledMesh
    colours : (n_measured, c) float64
        0..255, NaN where a vertex has none.
    edges : EdgeStatistics
        Of the scan.
    rng : numpy.random.Generator

    Returns
    -------
    NewColours
    """
    part = Surroundings.of_fills(filled, edges, rng)
    near = part.region.vertices[: part.filled.n_measured_vertices]
    known = colours[near]
    mesh, hole = _coloured_part(part.filled, known)
    n_holes, n_new = len(filled.disagreement), len(hole) - len(known)
    if not (hole >= 0).any():
        return NewColours(None)
    gap = hide_disks(mesh, hole, n_holes, edges.mean, rng)
    n_gaps = int(gap.max()) + 1
    if n_gaps - n_holes < MIN_HOLES:
        return NewColours(None)
    whole = np.concatenate([np.nan_to_num(known), np.zeros((n_new, known.shape[1]))])
    surface = ColouredSurface.of_measured(mesh, whole, gap, n_gaps, edges.mean)
    new, verdict = _new_colours(surface, n_holes, whole, rng)
    if new is None:
        return NewColours(None, verdict)
    found = np.full((n_new, known.shape[1]), np.nan)
    found[hole[len(known) :] >= 0] = new
    return NewColours(found, verdict)


def _coloured_part(filled: FilledMesh, colours: FloatArray) -> tuple[TriangleMesh, IntArray]:
    """Triangles whose corners have colours or get them, and the hole (n_vertices,) of each new vertex, -1 for others.

    Holes with a rim vertex that has no colour are left out.
    """
    mesh, n = filled.mesh, len(colours)
    bare = np.zeros(len(mesh.vertices), bool)
    bare[:n] = ~np.isfinite(colours).all(axis=1)
    has_bare = np.asarray(bare[mesh.triangles].any(axis=1))
    is_left_out = np.zeros(len(filled.disagreement), bool)
    is_left_out[filled.triangle_hole[has_bare[filled.n_measured_triangles :]]] = True
    has_bare[filled.n_measured_triangles :] |= is_left_out[filled.triangle_hole]
    hole = np.full(len(mesh.vertices), -1)
    hole[n:] = np.where(is_left_out[filled.vertex_hole], -1, filled.vertex_hole)
    return TriangleMesh(mesh.vertices, mesh.triangles[~has_bare]), hole


def _new_colours(
    surface: ColouredSurface, n_holes: int, truth: FloatArray, rng: np.random.Generator
) -> tuple[FloatArray | None, Verdict | None]:
    """Colour the first gaps (n, c) by what is learned from the others, whose truth is known; None for harmonic."""
    real, tried = (GapGraph.of_gaps(surface, *ends) for ends in ((0, n_holes), (n_holes, surface.n_gaps)))
    widest = cell_radius(surface, real)
    for radius in (widest, widest / 2, widest / 4):
        cells = divide(surface, real, radius)
        matcher = _Matcher(surface, radius, len(cells.seeds), rng)
        if matcher.n_sources >= _LEAST_FOUND:
            break
    else:
        return None, None
    maker = matcher.detail_maker(tried, divide(surface, tried, radius))
    belief, verdict = calibrate(surface, maker, truth[tried.vertices])
    if not verdict.is_better:
        return None, verdict
    detail = Detail(surface, matcher.detail_maker(real, cells), belief.choice)
    return detail.coloured(belief, detail.affordable_share(belief)), verdict


class _Matcher:
    """Looks for exemplars in one set of sources.

    Parameters
    ----------
    surface : ColouredSurface
    radius : float
        Of cells, in mesh units.
    n_cells : int
        That exemplars are wanted for.
    rng : numpy.random.Generator

    Attributes
    ----------
    n_sources : int
        That were found.
    """

    def __init__(self, surface: ColouredSurface, radius: float, n_cells: int, rng: np.random.Generator) -> None:
        self._surface = surface
        self._sampler = PatchSampler(surface, 2 * (radius + MARGIN * surface.edge_length))
        affordable = _MATCHING_BUDGET / (n_cells * cost_of_match(surface.colours.shape[1]))
        self._sources = self._sampler.sources(int(np.clip(affordable, *_SOURCES)), rng)
        self.n_sources = len(self._sources)

    def detail_maker(self, graph: GapGraph, cells: Cells) -> DetailMaker:
        """Look for exemplars for the cells of some gaps."""
        patches = self._sampler.cut(cells.seeds)
        most = int(np.clip(_LENDING_BUDGET / len(graph.vertices), *_MATCHES))
        matches = find_matches(patches, self._sources, most)
        return DetailMaker(graph, cells, matches, Lender(self._surface, patches, self._sources))
