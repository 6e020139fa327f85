import numpy as np
import pytest

from quadpatch.colours.cells import Cells, divide
from quadpatch.colours.detail import Choice, DetailMaker
from quadpatch.colours.exemplars import Lender, Matches
from quadpatch.colours.gap_graph import GapGraph
from quadpatch.colours.surface import ColouredSurface
from quadpatch.types import FloatArray, IntArray
from tests.quadpatch.shapes import open_grid

MESH = open_grid(61)
RNG = np.random.default_rng(0)
# Left of x = 0 colours vary slowly, right of it from vertex to vertex.
SLOW = 60 * np.sin(MESH.vertices[:, :1] / 3) * np.cos(MESH.vertices[:, 1:2] / 3)
COLOURS = 128 + np.where(MESH.vertices[:, :1] < 0, SLOW, RNG.normal(0, 20, (len(MESH.vertices), 1))) * np.ones(3)
GAP = np.where(np.linalg.norm(MESH.vertices[:, :2] - (15.0, 15.0), axis=1) < 4, 0, -1)
SURFACE = ColouredSurface.of_measured(MESH, COLOURS, GAP, 1, 1.0)
GRAPH = GapGraph.of_gaps(SURFACE, 0, 1)


class Shifting(Lender):
    """Lends from vertices that lie some rows and columns off, those of source k by shift k."""

    def __init__(self, *shifts: int) -> None:
        self.surface, self._shifts = SURFACE, np.array(shifts)

    def lend(self, source: IntArray, window: IntArray, cell: IntArray, vertex: IntArray) -> IntArray:
        return np.asarray(vertex + self._shifts[source[cell]])


def maker(cells: Cells, *shifts: int) -> DetailMaker:
    source = np.tile(np.arange(len(shifts)), (len(cells.seeds), 1))
    return DetailMaker(GRAPH, cells, Matches(source, source), Shifting(*shifts))


def poisson(shift: int) -> FloatArray:
    """What is lent from a shift, less the harmonic extension of its rim."""
    lent = np.zeros_like(COLOURS)
    touched = np.union1d(GRAPH.vertices, GRAPH.end)
    lent[touched] = COLOURS[touched + shift]
    return (lent - ColouredSurface.of_measured(MESH, lent, GAP, 1, 1.0).colours)[GRAPH.vertices]


WHOLE = divide(SURFACE, GRAPH, 10.0)
DIVIDED = divide(SURFACE, GRAPH, 2.5)
# Rows are 61 vertices long.
DOWN, LEFT = -20 * 61, -30


@pytest.mark.parametrize("cells", [WHOLE, DIVIDED], ids=["one cell", "several cells"])
def test_detail_of_one_exemplar_is_its_colours_less_the_harmonic_extension_of_its_rim(cells: Cells) -> None:
    assert np.allclose(maker(cells, DOWN).make(Choice(1, 0.0)), poisson(DOWN))


def test_the_best_match_is_taken_where_there_is_one_candidate_and_the_finest_of_several() -> None:
    both = maker(WHOLE, LEFT, DOWN)
    assert np.allclose(both.make(Choice(1, 0.0)), poisson(LEFT))
    assert np.allclose(both.make(Choice(2, 0.0)), poisson(DOWN))


def test_cells_choose_the_finest_each_for_itself() -> None:
    one, other = maker(DIVIDED, LEFT).make(Choice(1, 0.0)), maker(DIVIDED, DOWN).make(Choice(1, 0.0))
    found = maker(DIVIDED, LEFT, DOWN).make(Choice(2, 0.0))
    # A cell at the rim may find the other one finer.
    assert np.linalg.norm(found - other) < 0.5 * np.linalg.norm(found - one)


def test_a_colour_that_is_the_same_everywhere_has_no_detail() -> None:
    plain = ColouredSurface.of_measured(MESH, np.full_like(COLOURS, 90.0), GAP, 1, 1.0)
    lender = Shifting(DOWN)
    lender.surface = plain
    source = np.zeros((len(DIVIDED.seeds), 1), np.int64)
    assert not DetailMaker(GRAPH, DIVIDED, Matches(source, source), lender).make(Choice(1, 0.0)).any()
