"""Coloured surfaces with holes, whose true colours are known."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.harmonic import extend_harmonically
from quadpatch.mesh.measures import EdgeStatistics, edge_statistics
from quadpatch.mesh.topology import directed_edges
from quadpatch.options import RepairOptions
from quadpatch.recipes.default import inpaint
from quadpatch.types import FloatArray
from tests.quadpatch.shapes import bumpy_plate, on_surface, punched

PLACES = ((0.5, 0.4), (-0.5, -0.45), (0.4, -0.5), (-0.45, 0.5))


def grains(vertices: FloatArray, rng: np.random.Generator, size: float) -> FloatArray:
    """Colours (n, 3) of a granite: dark and red grains of a size on grey, none of them like another."""
    centres = rng.uniform(-1.1, 1.1, (round(1.2 / size**2), 2))
    tints = np.array([[60, 55, 50], [170, 90, 80], [200, 200, 195]])[rng.integers(3, size=len(centres))]
    nearest = np.linalg.norm(vertices[:, np.newaxis, :2] - centres, axis=2).argmin(axis=1)
    return np.asarray(tints[nearest] + rng.normal(0, 4, (len(vertices), 3))).clip(0, 255)


def stripes(vertices: FloatArray, width: float) -> FloatArray:
    """Colours (n, 3) that change along x and are the same along y."""
    wave = np.sin(2 * np.pi * vertices[:, :1] / width)
    return np.asarray(128 + np.array([100.0, -80.0, 60.0]) * wave)


def even(vertices: FloatArray) -> FloatArray:
    """Colours (n, 3) that change evenly."""
    return np.asarray(128 + vertices[:, [0, 1, 0]] * np.array([100.0, 90.0, -60.0]))


@dataclass(frozen=True)
class Coloured:
    """A filled mesh and the colours (n_measured, 3) of its measured vertices, unused ones included."""

    filled: FilledMesh
    colours: FloatArray

    @property
    def edges(self) -> EdgeStatistics:
        return edge_statistics(self.filled.measured)

    @cached_property
    def harmonic(self) -> FloatArray:
        """Colours of all vertices, harmonic where they are new."""
        n = len(self.filled.mesh.vertices)
        known = np.arange(n) < self.filled.n_measured_vertices
        values = np.zeros((n, 3))
        values[known] = np.nan_to_num(self.colours)
        new = self.filled.mesh.triangles[self.filled.n_measured_triangles :]
        return np.asarray(extend_harmonically(directed_edges(new), known, values))

    def energy(self, new: FloatArray) -> float:
        """Squared differences along the edges of the fills, with colours (n_new, 3) of the new vertices."""
        colours = np.concatenate([self.harmonic[: self.filled.n_measured_vertices], new])
        edges = directed_edges(self.filled.mesh.triangles[self.filled.n_measured_triangles :])
        return float(((colours[edges[:, 0]] - colours[edges[:, 1]]) ** 2).sum())


def plate(n: int = 90, radius: float = 0.12) -> FilledMesh:
    """Fill four holes of a plate; mean edges are about 2.5 / n wide."""
    whole = bumpy_plate(n, 2.0)
    return inpaint(punched(whole, *on_surface(whole, *PLACES), radius=radius), None, RepairOptions()).filled
