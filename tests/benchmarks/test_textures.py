from pathlib import Path

import numpy as np
import pytest

from benchmarks.colours import ColouredMesh, write_coloured
from benchmarks.textures import TexturedMesh, baked, barycentric, bricks, colours_at, sampled, score, write_textured
from quadpatch.formats.reading import read_scan
from quadpatch.textures.images import DecodedImage
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import open_grid

PLATE = bricks(64, 12)
INNER = np.abs(PLATE.mesh.vertices[PLATE.mesh.triangles].mean(axis=1)[:, :2]).max(axis=1) < 0.25
LOST = TexturedMesh(
    TriangleMesh(PLATE.mesh.vertices, PLATE.mesh.triangles[INNER]), PLATE.coordinates[INNER], PLATE.pixels
)


def test_the_truth_itself_keeps_all_and_has_no_error() -> None:
    psnr, kept = score(PLATE, LOST, LOST)
    assert psnr > 60
    assert kept == pytest.approx(1.0)


def test_one_colour_keeps_nothing() -> None:
    plain = TexturedMesh(LOST.mesh, LOST.coordinates, np.full_like(LOST.pixels, 128))
    assert score(PLATE, LOST, plain)[1] == pytest.approx(0.0)


def test_a_texel_is_as_wide_as_the_image_divides_the_plate() -> None:
    assert pytest.approx(1 / 64, rel=0.05) == PLATE.texel
    corners, triangles, colours = sampled(PLATE, PLATE.texel)
    edges = corners[triangles] - np.roll(corners[triangles], 1, axis=1)
    assert np.linalg.norm(edges, axis=2).max() <= PLATE.texel
    assert len(colours) == len(corners)


def test_colours_between_texels_are_means() -> None:
    pixels = np.array([[[0, 0, 0], [100, 100, 100]], [[0, 0, 0], [100, 100, 100]]], np.uint8)
    assert colours_at(pixels, np.array([[0.5, 0.5], [0.25, 0.5], [0.75, 0.3]])).tolist() == [
        [50] * 3,
        [0] * 3,
        [100] * 3,
    ]


def test_barycentric_coordinates_lead_back() -> None:
    weights = np.array([[0.2, 0.3, 0.5], [1.0, 0.0, 0.0]])
    points = np.einsum("kc,kcx->kx", weights, PLATE.mesh.vertices[PLATE.mesh.triangles[[3, 7]]])
    assert np.allclose(barycentric(PLATE.mesh, np.array([3, 7]), points), weights)


def test_colours_of_vertices_are_baked_into_an_atlas(tmp_path: Path) -> None:
    grid = open_grid(9, 10.0)
    colours = 128 + grid.vertices * np.array([10.0, -8.0, 0.0])
    write_coloured(tmp_path / "ramp.ply", ColouredMesh(grid, colours))
    atlas = baked(tmp_path / "ramp.ply", 256)
    middles = atlas.coordinates.mean(axis=1)
    assert np.abs(colours_at(atlas.pixels, middles) - colours[grid.triangles].mean(axis=1)).max() < 3


def test_a_textured_file_comes_back(tmp_path: Path) -> None:
    write_textured(tmp_path / "scan.ply", PLATE)
    scan = read_scan(tmp_path / "scan.ply")
    assert scan.source is not None
    texture = scan.source.surface_texture(scan)
    assert texture is not None
    (image,) = texture.images
    assert image is not None
    assert (texture.coordinates == PLATE.coordinates).all()
    assert (DecodedImage(image).width, DecodedImage(image).height) == (64, 64)
