"""Detail of exemplars, put into gaps."""

from dataclasses import dataclass

import numpy as np

from quadpatch.colours.cells import Cells
from quadpatch.colours.exemplars import Lender, Matches
from quadpatch.colours.gap_graph import GapGraph
from quadpatch.types import FloatArray, IntArray


@dataclass(frozen=True)
class Choice:
    """How detail is chosen and put in.

    Attributes
    ----------
    candidates : int
        Of so many best matches, the one is taken whose detail is finest: which departs least from the harmonic colours
        for the gradients that it brings. 1 takes the best match.
    screening : float
        See `quadpatch.colours.gap_graph`.
    """

    candidates: int
    screening: float


class DetailMaker:
    """Makes details for the gaps of a graph.

    Parameters
    ----------
    graph : GapGraph
    cells : Cells
    matches : Matches
    lender : Lender
    """

    def __init__(self, graph: GapGraph, cells: Cells, matches: Matches, lender: Lender) -> None:
        self.graph, self.matches, self._lender = graph, matches, lender
        self._cell = cells.of_vertex
        self._n_cells = len(cells.seeds)
        inner = graph.inner_end
        cell = self._cell[graph.start]
        self._within_cell = (inner >= 0) & (self._cell[inner] == cell)
        # Each cell lends to its own vertices, and to those beside it.
        n = int(max(graph.end.max(initial=0), graph.vertices.max(initial=0))) + 1
        keys = np.concatenate([cell * n + graph.vertices[graph.start], cell * n + graph.end])
        pairs, at = np.unique(keys, return_inverse=True)
        self._pair_cell, self._pair_vertex = pairs // n, pairs % n
        self._pair_start, self._pair_end = at.reshape(2, -1)
        self._reverse = self._reversed_edges()
        self._lent: dict[int, IntArray] = {}

    def make(self, choice: Choice) -> FloatArray:
        """Details (n, c) of all vertices of the graph."""
        rank = self._finest(choice) if choice.candidates > 1 else np.zeros(self._n_cells, np.int64)
        lenders = np.stack([self._lenders(k) for k in range(int(rank.max(initial=0)) + 1)])
        gradient = self._gradients(lenders[rank[self._pair_cell], np.arange(len(self._pair_cell))])
        # Where two cells meet, the mean of what both say; within a cell both directions say the same.
        both = self._reverse >= 0
        gradient[both] = 0.5 * (gradient[both] - gradient[self._reverse[both]])
        return self.graph.solver(choice.screening)(self._divergence(gradient))

    def _finest(self, choice: Choice) -> IntArray:
        """Rank (n_cells,) of the match whose detail departs least for its gradients, each cell by itself."""
        ratios = []
        solve = self.graph.solver(choice.screening, self._within_cell)
        # Loops over candidates.
        for rank in range(min(choice.candidates, self.matches.count)):
            detail = solve(self._divergence(self._gradients(self._lenders(rank))))
            squared = np.bincount(self._cell, (detail**2).sum(axis=1), minlength=self._n_cells)
            energy = self.graph.energy(detail, joined=self._within_cell)
            total = np.bincount(self._cell, energy, minlength=self._n_cells)
            ratios.append(np.divide(squared, total, out=np.full(self._n_cells, np.inf), where=total > 0))
        return np.asarray(np.argmin(ratios, axis=0))

    def _lenders(self, rank: int) -> IntArray:
        """Vertex that lends its colour to each pair, by the match of some rank."""
        if rank not in self._lent:
            source, window = self.matches.source[:, rank], self.matches.window[:, rank]
            self._lent[rank] = self._lender.lend(source, window, self._pair_cell, self._pair_vertex)
        return self._lent[rank]

    def _gradients(self, lenders: IntArray) -> FloatArray:
        """Differences (e, c) along all edges between the colours that pairs are lent."""
        colours = self._lender.surface.colours[lenders]
        return np.asarray(colours[self._pair_start] - colours[self._pair_end])

    def _divergence(self, gradients: FloatArray) -> FloatArray:
        n = len(self.graph.vertices)
        sums = [np.bincount(self.graph.start, column, minlength=n) for column in gradients.T]
        return np.stack(sums, axis=1)

    def _reversed_edges(self) -> IntArray:
        """Position (e,) of the same edge in the other direction, -1 for edges to the rim."""
        graph, n = self.graph, len(self.graph.vertices)
        reverse = np.full(len(graph.start), -1)
        tied = np.flatnonzero(graph.inner_end >= 0)
        keys = graph.start[tied] * n + graph.inner_end[tied]
        order = np.argsort(keys)
        wanted = graph.inner_end[tied] * n + graph.start[tied]
        reverse[tied] = tied[order[np.searchsorted(keys[order], wanted)]]
        return reverse
