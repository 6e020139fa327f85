"""Texture pages for the fills of a mesh: laid out as finely as the images around, and painted as vertices are.

Surface samples about as dense as texels take the colours of the images; over the fills they get colours as new
vertices do (`quadpatch.colours`), and texels get those of the samples.
"""

from dataclasses import dataclass, replace

import numpy as np

from quadpatch.colours.calibration import Verdict
from quadpatch.colours.continuation import NewColours, continue_colours
from quadpatch.colours.surface import ColouredSurface
from quadpatch.colours.surroundings import Surroundings
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.formats.surface_texture import ImageProblem, SurfaceTexture
from quadpatch.mesh.measures import edge_statistics
from quadpatch.textures.measured_texture import MeasuredTexture
from quadpatch.textures.page import Layout, lay_out, paint
from quadpatch.textures.samples import Samples, take_samples
from quadpatch.types import FloatArray, IntArray


@dataclass(frozen=True)
class Page:
    """A page for some fills.

    Attributes
    ----------
    png : bytes
    layout : Layout
        Of the triangles `rows`.
    rows : (l,) int64
        Which of the new triangles lie on it.
    material : (l,) int64
        That each goes on with.
    """

    png: bytes
    layout: Layout
    rows: IntArray
    material: IntArray


@dataclass(frozen=True)
class PaintedFills:
    """Texture of the fills of a mesh.

    Attributes
    ----------
    page : Page or None
        None where no hole lies in an image that can be read.
    method : str or None
        `exemplars` or `harmonic`; None without a page.
    verdict : Verdict or None
        See `quadpatch.colours.continuation.NewColours`.
    problems : list of ImageProblem
        Images that were needed and could not be read.
    """

    page: Page | None
    method: str | None
    verdict: Verdict | None
    problems: list[ImageProblem]


def paint_fills(
    filled: FilledMesh, texture: SurfaceTexture, rng: np.random.Generator, *, is_harmonic: bool
) -> PaintedFills:
    """Paint a page for those fills of a mesh whose surroundings have an image.

    Parameters
    ----------
    filled : FilledMesh
    texture : SurfaceTexture
        Of its measured triangles.
    rng : numpy.random.Generator
    is_harmonic : bool
        Whether harmonic colours are asked for.
    """
    measured = MeasuredTexture(filled, texture)
    material = measured.materials_of_holes()
    density = measured.texels_per_unit(material)
    # A hole whose image turns out broken when it is decoded is left out, and the others start anew.
    while (density > 0).any():
        near, samples = _sampled(measured, density, rng)
        broken = [number for number in near.problems if number not in measured.problems]
        measured.problems.update(near.problems)
        if not broken:
            break
        density = np.where(np.isin(material, broken), 0.0, density)
    problems = list(measured.problems.values())
    if not (density > 0).any():
        return PaintedFills(None, None, None, problems)
    new = _colours(samples, rng, is_harmonic)
    rows = np.flatnonzero((density > 0)[filled.triangle_hole])
    triangles = filled.mesh.triangles[filled.n_measured_triangles :][rows]
    hole = filled.triangle_hole[rows]
    layout = lay_out(filled.mesh.vertices, triangles, hole, density)
    corners = np.einsum("lkc,lcx->lkx", samples.corners, layout.corners[samples.parent])
    fine = samples.filled.mesh.triangles[samples.filled.n_measured_triangles :]
    colours = np.concatenate([samples.colours, _complete(samples, new.colours)])
    page = Page(paint(layout, corners, fine, colours), layout, rows, material[hole])
    return PaintedFills(page, new.method, new.verdict, problems)


def _sampled(
    measured: MeasuredTexture, density: FloatArray, rng: np.random.Generator
) -> tuple[MeasuredTexture, Samples]:
    """Sample the surroundings of the holes that have a density."""
    filled = measured.filled.without(np.flatnonzero(density == 0))
    texel = 1.0 / float(np.median(density[density > 0]))
    part = Surroundings.of_fills(filled, edge_statistics(filled.measured), rng, texel)
    given, region = measured.texture, part.region
    coordinates, material = region.of_triangles(given.coordinates), region.of_triangles(given.material)
    texture = replace(given, coordinates=coordinates, material=material)
    near = MeasuredTexture(part.filled, texture, dict(measured.problems))
    return near, take_samples(near, texel)


def _colours(samples: Samples, rng: np.random.Generator, is_harmonic: bool) -> NewColours:
    if is_harmonic or not len(samples.filled.vertex_hole):
        return NewColours(None)
    fine = samples.filled
    return continue_colours(fine, samples.colours, edge_statistics(fine.measured), rng)


def _complete(samples: Samples, new: FloatArray | None) -> FloatArray:
    """Colours (n_new, c) of all new samples: harmonic where no others are given."""
    fine = samples.filled
    n_new, n_channels = len(fine.vertex_hole), samples.colours.shape[1]
    given = np.full((n_new, n_channels), np.nan) if new is None else new
    gap = np.concatenate([np.full(fine.n_measured_vertices, -1), np.zeros(n_new, np.int64)])
    whole = np.concatenate([samples.colours, np.zeros((n_new, n_channels))])
    edge = edge_statistics(fine.measured).mean
    harmonic = ColouredSurface.of_measured(fine.mesh, np.nan_to_num(whole), gap, 1, edge).colours
    return np.where(np.isfinite(given), given, harmonic[fine.n_measured_vertices :])
