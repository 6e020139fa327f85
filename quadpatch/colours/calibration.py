"""How much detail new colours get: tried where colours were measured and hidden.

Harmonic colours are nearly the best guess of each single vertex; detail that is not that of the truth adds its square
to their error, but makes a gap look like its surroundings. Both are measured on calibration holes, whose true colours
are known: the error of harmonic colours beside the roughness around a hole, which says how large it is in real gaps;
what part of a detail is true; and the gradient energy that is kept. Gaps then get as much detail as costs a set loss
of PSNR at most, and no more than the truth has. Where what is gained so does not outweigh what is lost, harmonic
colours stay.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.colours.detail import Choice, DetailMaker
from quadpatch.colours.gap_graph import GapGraph
from quadpatch.colours.surface import ColouredSurface
from quadpatch.types import FloatArray, IntArray, Vertices

# What detail may cost in real gaps, in decibels of PSNR, as calibration expects it.
MOST_LOST_DB = 0.95
# What the whole gradient energy of the truth is worth, in decibels: detail that costs one has to bring a quarter of it.
_WORTH_DB = 4.0
# Harmonic colours that keep more of it are no blur: colours vary evenly there, and any detail would be wrong.
_BLURRED = 0.67
CHOICES = (Choice(1, 0.0), Choice(64, 0.3), Choice(64, 1.0))
# Shares of the expected energy that gaps are brought to at most: the largest that is affordable is taken.
_SHARES = np.linspace(0.0, 1.0, 51)
# Detail may be strengthened so many times.
_MOST_GAIN = 3.0
# The surroundings of a gap end so many mean edges beyond it.
_SURROUNDINGS = 3.0
# Standard errors that are taken off the part of a detail that is true.
_CAUTION = 1.64
_TINY = 1e-9


@dataclass(frozen=True)
class Belief:
    """What calibration says of details of one choice.

    Attributes
    ----------
    choice : Choice
    error_per_roughness : float
        Squared error of harmonic colours, over mean squared differences along the edges around.
    energy_per_roughness : float
        Gradient energy of the truth, over what it were if gaps were as rough as their surroundings.
    true_part : float
        Least-squares factor from details to what harmonic colours lack, less its uncertainty; 0 for details that are
        like the truth in kind alone.
    """

    choice: Choice
    error_per_roughness: float
    energy_per_roughness: float
    true_part: float


@dataclass(frozen=True)
class Verdict:
    """What calibration holes say of colours with detail.

    Attributes
    ----------
    gain_db : float
        PSNR, less that of harmonic colours.
    kept, kept_harmonic : float
        Gradient energy over that of the truth, with detail and with harmonic colours.
    n_holes : int
    """

    gain_db: float
    kept: float
    kept_harmonic: float
    n_holes: int

    @property
    def is_better(self) -> bool:
        """Whether harmonic colours are a blur, and detail is better."""
        return self.kept_harmonic < _BLURRED and self.advantage_db > 0

    @property
    def advantage_db(self) -> float:
        """By how much detail is better than harmonic colours, in decibels: PSNR and what kept gradients are worth."""
        return self.gain_db + _WORTH_DB * (min(self.kept, 1.0) - min(self.kept_harmonic, 1.0))


class Detail:
    """Detail of one choice in the gaps of a graph, and its figures for each of the gaps.

    Parameters
    ----------
    surface : ColouredSurface
    maker : DetailMaker
    choice : Choice
    """

    def __init__(self, surface: ColouredSurface, maker: DetailMaker, choice: Choice) -> None:
        graph = maker.graph
        self.graph, self.values = graph, maker.make(choice)
        self.harmonic = surface.colours[graph.vertices]
        self.of_gaps, self._gap = np.unique(graph.gap, return_inverse=True)
        self.squared = self._sum((self.values**2).sum(axis=1))
        self.energy = self._sum(graph.energy(self.values))
        self.harmonic_energy = self._sum(graph.energy(self.harmonic, surface.colours))
        # Of vertices, and of edges, if gaps were as rough as what lies around them.
        around, self._low, self._high = _surroundings(surface, graph, self.of_gaps)
        self.vertex_roughness = around * self._sum(np.ones(len(graph.vertices)))
        per_edge = np.where(graph.inner_end >= 0, 0.5, 1.0)
        edges = np.bincount(graph.start, per_edge, minlength=len(graph.vertices)).astype(np.float64)
        self.edge_roughness = around * self._sum(edges)

    def coloured(self, belief: Belief, share: float) -> FloatArray:
        """Colours (n, c) with detail that brings each gap to a share of the expected energy.

        They stay within the range of the colours around the gap.
        """
        detailed = self.harmonic + self._gains(belief, share)[self._gap][:, np.newaxis] * self.values
        return np.clip(detailed, self._low[self._gap], self._high[self._gap])

    def affordable_share(self, belief: Belief) -> float:
        """Say to which share of the expected energy detail may bring the gaps."""
        error = belief.error_per_roughness * self.vertex_roughness.sum()
        most = error * 10 ** (MOST_LOST_DB / 10)
        for share in _SHARES[::-1].tolist():
            added = self.coloured(belief, share) - self.harmonic
            # Of what harmonic colours lack, the details are expected to hold their true part.
            if error + float((added * (added - 2 * belief.true_part * self.values)).sum()) <= most:
                return float(share)
        return 0.0

    def believed(self, choice: Choice, truth: FloatArray, rim: FloatArray) -> Belief:
        """Compare with the truth (n, c), which continues the colours (n_vertices, c) of the surface."""
        lacking = truth - self.harmonic
        error = self._sum((lacking**2).sum(axis=1))
        common = self._sum((lacking * self.values).sum(axis=1))
        total = max(float(self.squared.sum()), _TINY)
        part = float(common.sum()) / total
        uncertainty = float(np.sqrt(((common - part * self.squared) ** 2).sum())) / total
        true_energy = float(self.graph.energy(truth, rim).sum())
        return Belief(
            choice,
            float(error.sum()) / max(float(self.vertex_roughness.sum()), _TINY),
            true_energy / max(float(self.edge_roughness.sum()), _TINY),
            float(np.clip(part - _CAUTION * uncertainty, 0.0, 1.0)),
        )

    def judged(self, belief: Belief, share: float, truth: FloatArray, rim: FloatArray) -> Verdict:
        """Compare with the truth (n, c), which continues the colours (n_vertices, c) of the surface."""
        coloured = self.coloured(belief, share)
        energies = [float(self.graph.energy(colours, rim).sum()) for colours in (coloured, self.harmonic, truth)]
        true_energy = max(energies[2], _TINY)
        errors = [max(float(((colours - truth) ** 2).sum()), _TINY) for colours in (coloured, self.harmonic)]
        gain_db = 10 * float(np.log10(errors[1] / errors[0]))
        return Verdict(gain_db, energies[0] / true_energy, energies[1] / true_energy, len(self.of_gaps))

    def _gains(self, belief: Belief, share: float) -> FloatArray:
        """Say how many times (n_gaps,) the details are taken."""
        expected = belief.energy_per_roughness * self.edge_roughness
        missing = np.maximum(share * expected - self.harmonic_energy, 0.0)
        ratio = np.divide(missing, self.energy, out=np.zeros_like(missing), where=self.energy > 0)
        return np.minimum(np.sqrt(ratio), _MOST_GAIN)

    def _sum(self, of_vertex: FloatArray) -> FloatArray:
        return np.bincount(self._gap, of_vertex, minlength=len(self.of_gaps)).astype(np.float64)


def calibrate(surface: ColouredSurface, maker: DetailMaker, truth: FloatArray) -> tuple[Belief, Verdict]:
    """Find the choice that leaves gaps of known colours most like the truth.

    Parameters
    ----------
    surface : ColouredSurface
    maker : DetailMaker
        Of these gaps.
    truth : (n, c) float64
        Colours of the vertices of its graph.
    """
    found = []
    for choice in CHOICES:
        detail = Detail(surface, maker, choice)
        belief = detail.believed(choice, truth, surface.colours)
        found.append((belief, detail.judged(belief, detail.affordable_share(belief), truth, surface.colours)))
    return max(found, key=lambda pair: pair[1].advantage_db)


def _surroundings(
    surface: ColouredSurface, graph: GapGraph, gaps: IntArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Look at the measured vertices around gaps: mean squared difference along edges (k,), and range of colours (k, c).

    Without any, the first is 0, and the range that of all colours.
    """
    colours, n_channels = surface.colours[surface.measured_vertices], surface.colours.shape[1]
    roughness, points = surface.roughness[surface.measured_vertices], surface.mesh.vertices[graph.vertices]
    mean, low, high = np.zeros(len(gaps)), np.zeros((len(gaps), n_channels)), np.full((len(gaps), n_channels), 255.0)
    order = np.argsort(graph.gap, kind="stable")
    ends = np.searchsorted(graph.gap[order], gaps, side="right")
    # Loops over gaps.
    for number, members in enumerate(np.split(order, ends[:-1])):
        near = _near(surface, points[members])
        if len(near):
            mean[number] = float(roughness[near].mean())
            low[number], high[number] = colours[near].min(axis=0), colours[near].max(axis=0)
    return mean, low, high


def _near(surface: ColouredSurface, points: Vertices) -> IntArray:
    """Measured vertices (k,) around a gap, numbered as `measured_vertices`."""
    centre = points.mean(axis=0)
    radius = float(np.linalg.norm(points - centre, axis=1).max()) + _SURROUNDINGS * surface.edge_length
    return np.array(surface.measured_tree.query_ball_point(centre, radius), dtype=np.int64)
