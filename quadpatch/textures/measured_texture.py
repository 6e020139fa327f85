"""The texture of the measured part of a filled mesh: what its holes go on with, how fine it is, and its colours.

Tested in `tests/quadpatch/textures/test_painting.py`.
"""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from quadpatch.errors import ImageTooLargeError, TextureError
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.formats.surface_texture import ImageProblem, SurfaceTexture, TextureImage
from quadpatch.mesh.normals import area_vectors, length
from quadpatch.mesh.topology import directed_edges, edge_keys
from quadpatch.textures.images import DecodedImage, size_of
from quadpatch.types import BoolArray, FloatArray, IntArray

# Pixels of all images of a scan that are decoded.
MOST_PIXELS_IN_ALL = 1 << 29
# How far from the border of a chart colours are read, in texels: beyond it an atlas may hold anything.
_INSIDE = 0.75


@dataclass
class MeasuredTexture:
    """Images on the measured triangles of a filled mesh.

    Attributes
    ----------
    filled : FilledMesh
    texture : SurfaceTexture
        Of its measured triangles.
    problems : dict
        Of images, by material: those that were needed and could not be read.
    """

    filled: FilledMesh
    texture: SurfaceTexture
    problems: dict[int, ImageProblem] = field(default_factory=dict)

    @cached_property
    def has_texture(self) -> BoolArray:
        """Triangles (m,) that have an image and lie in it."""
        named = np.array([image is not None for image in self.texture.images] + [False])
        return np.asarray(named[self.texture.material] & np.isfinite(self.texture.coordinates).all(axis=(1, 2)))

    @cached_property
    def rim_edges(self) -> tuple[IntArray, IntArray]:
        """Edges of measured triangles, as `directed_edges` has them, that fills join, and the hole of each: (k,)."""
        filled = self.filled
        n, m = len(filled.mesh.vertices), filled.n_measured_triangles
        keys = edge_keys(directed_edges(filled.mesh.triangles), n)
        measured, new = keys[: 3 * m], keys[3 * m :]
        order = np.argsort(new, kind="stable")
        at = np.searchsorted(new[order], measured).clip(max=max(len(new) - 1, 0))
        joined = np.flatnonzero(new[order][at] == measured) if len(new) else np.zeros(0, np.int64)
        return joined, filled.triangle_hole[order[at[joined]] // 3]

    def materials_of_holes(self) -> IntArray:
        """Material (n_holes,) that the longer part of each rim has, -1 for none and for those without a texture."""
        edge, hole = self.rim_edges
        corners = directed_edges(self.filled.mesh.triangles[: self.filled.n_measured_triangles])[edge]
        vertices = self.filled.mesh.vertices
        votes = np.zeros((len(self.filled.disagreement), len(self.texture.images) + 1))
        material = np.where(self.has_texture[edge // 3], self.texture.material[edge // 3], -1)
        plain = np.where(material < 0, len(self.texture.images), material)
        np.add.at(votes, (hole, plain), length(vertices[corners[:, 1]] - vertices[corners[:, 0]]))
        # Of equal parts the material of the lower number wins.
        chosen = np.where(votes.any(axis=1), votes.argmax(axis=1), len(self.texture.images))
        return np.asarray(np.where(chosen == len(self.texture.images), -1, chosen))

    def texels_per_unit(self, material_of_hole: IntArray) -> FloatArray:
        """Texels along a mesh unit (n_holes,) at each rim, in the image of the hole's material; 0 for no texture.

        Only headers of images are read. What is wrong with one is noted in `problems`.
        """
        edge, hole = self.rim_edges
        near = edge // 3
        fits = self.has_texture[near] & (self.texture.material[near] == material_of_hole[hole])
        near, hole = near[fits], hole[fits]
        triangles = self.filled.mesh.triangles[near]
        areas = length(area_vectors(self.filled.mesh.vertices, triangles))
        a, b, c = (self.texture.coordinates[near, corner] for corner in range(3))
        flat = np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
        n_texels = np.array([self._n_texels(number) for number in range(len(self.texture.images))])
        flat = flat * n_texels[self.texture.material[near]]
        n = len(self.filled.disagreement)
        total, texels = (np.bincount(hole, values, minlength=n) for values in (areas, flat))
        return np.asarray(np.sqrt(np.divide(texels, total, out=np.zeros(n), where=total > 0)))

    def _n_texels(self, material: int) -> float:
        """Texels of the image of a material that a triangle at a rim has; 0 without one that can be read."""
        image = self.texture.images[material]
        edge = self.rim_edges[0]
        if image is None or not (self.has_texture[edge // 3] & (self.texture.material[edge // 3] == material)).any():
            return 0.0
        try:
            width, height = size_of(image)
        except TextureError as error:
            self.note(material, error)
            return 0.0
        return float(width) * height

    def note(self, material: int, error: TextureError) -> None:
        """Keep what is wrong with the image of a material."""
        image = self.texture.images[material]
        assert image is not None
        self.problems[material] = ImageProblem(image.name, error.code, str(error))

    def colours_at(self, triangle: IntArray, weights: FloatArray) -> FloatArray:
        """Colours (k, 3 or 4) at places of triangles, NaN without a texture; images are decoded one after another.

        Parameters
        ----------
        triangle : (k,) int64
        weights : (k, 3) float64
            Barycentric coordinates.

        Returns
        -------
        (k, 3 or 4) float64
            0..255; red, green, blue, and alpha where one of the images has it.
        """
        material = np.where(self.has_texture[triangle], self.texture.material[triangle], -1)
        colours = np.full((len(triangle), 4), np.nan)
        has_alpha, n_pixels = False, 0
        on_border = (self._is_border[triangle] & (np.roll(weights, -2, axis=1) == 0)).any(axis=1)
        for number in np.unique(material[material >= 0]).tolist():
            image = self.texture.images[number]
            if image is None or number in self.problems:
                continue
            try:
                n_pixels = _counted(n_pixels, image)
                decoded = DecodedImage(image)
            except TextureError as error:
                self.note(number, error)
                continue
            rows = np.flatnonzero(material == number)
            size = np.array([decoded.width, decoded.height])
            places = self._places(triangle[rows], weights[rows], on_border[rows], size)
            colours[rows] = decoded.colours_at(places)
            has_alpha |= decoded.has_alpha
        return colours if has_alpha else colours[:, :3]

    def _places(self, triangle: IntArray, weights: FloatArray, on_border: BoolArray, size: IntArray) -> FloatArray:
        """Texture coordinates (k, 2) of places; those on the border of a chart a little inside of it."""
        corners = self.texture.coordinates[triangle]
        places = np.einsum("kc,kcx->kx", weights, corners)
        inwards = (corners.mean(axis=1) - places) * on_border[:, np.newaxis]
        distance = np.linalg.norm(inwards * size, axis=1)
        step = np.divide(_INSIDE, distance, out=np.zeros_like(distance), where=distance > 0).clip(max=1.0)
        return np.asarray(places + step[:, np.newaxis] * inwards)

    @cached_property
    def _is_border(self) -> BoolArray:
        """Edges (m, 3) of measured triangles beyond which the image does not go on as the surface does."""
        m = self.filled.n_measured_triangles
        edges = directed_edges(self.filled.mesh.triangles[:m])
        turned = edges[:, 0] > edges[:, 1]
        at_ends = np.stack([self.texture.coordinates, np.roll(self.texture.coordinates, -1, axis=1)], axis=2)
        at_ends = np.nan_to_num(at_ends.reshape(-1, 2, 2), nan=np.inf)
        at_ends[turned] = at_ends[turned][:, ::-1]
        keys = edge_keys(edges, len(self.filled.mesh.vertices))
        order = np.argsort(keys, kind="stable")
        is_same = keys[order][1:] == keys[order][:-1]
        is_same &= (at_ends[order][1:] == at_ends[order][:-1]).all(axis=(1, 2))
        is_inner = np.zeros(len(keys), bool)
        is_inner[order[1:][is_same]] = True
        is_inner[order[:-1][is_same]] = True
        return ~is_inner.reshape(-1, 3)


def _counted(n_pixels: int, image: TextureImage) -> int:
    """Add the pixels of an image to those of others; raise ImageTooLargeError where these are too many."""
    width, height = size_of(image)
    if n_pixels + width * height > MOST_PIXELS_IN_ALL:
        raise ImageTooLargeError(
            f"the images of the mesh have more than {MOST_PIXELS_IN_ALL:,} pixels in all, the limit"
        )
    return n_pixels + width * height
