"""Attributes of invented vertices and triangles."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from quadpatch.formats.attributes import (
    extend_over_vertices,
    nearest_rim_triangle,
    nearest_rim_vertex,
    triangle_normals,
    vertex_normals,
)
from quadpatch.formats.reading import read_scan
from quadpatch.formats.scan import Fill, Scan
from quadpatch.formats.writing import write_scan
from tests.quadpatch.formats.coloured_files import FILES, colours_of
from tests.quadpatch.formats.fills import EMPTY, as_scan, cap_holes
from tests.quadpatch.shapes import open_grid, punched, sphere


def holed_ball() -> Scan:
    return as_scan(punched(sphere(3), (0, 0, 1), (1, 0, 0), radius=0.4))


def holed_plane() -> Scan:
    return as_scan(punched(open_grid(12), (0, 0, 0), radius=2.2))


def inner_cap(scan: Scan) -> Fill:
    """Close the hole of a plane but not its outer rim, which has more edges."""
    fill = cap_holes(scan)
    sizes = np.bincount(fill.triangle_hole_id)
    hole = int(np.argmin(sizes))
    vertices = np.flatnonzero(fill.vertex_hole_id == hole)
    number = np.full(len(fill.vertices), -1)
    number[vertices] = np.arange(len(vertices))
    triangles = fill.triangles[fill.triangle_hole_id == hole]
    n = len(scan.vertices)
    triangles = np.where(triangles < n, triangles, n + number[np.maximum(triangles - n, 0)])
    n_vertices, n_triangles = len(vertices), len(triangles)
    holes = np.zeros(n_vertices, np.int64), np.zeros(n_triangles, np.int64)
    return Fill(fill.vertices[vertices], triangles, holes[0], np.ones(n_vertices), holes[1], np.ones(n_triangles))


def test_a_constant_attribute_stays_constant_to_the_bit() -> None:
    scan = holed_ball()
    values = np.full((len(scan.vertices), 3), [0.1, 7.0, 255.0])
    extended = extend_over_vertices(cap_holes(scan), values)
    assert (extended == [0.1, 7.0, 255.0]).all()


def test_each_hole_takes_from_its_own_rim() -> None:
    scan = holed_ball()
    fill = cap_holes(scan)
    side = (scan.vertices[:, 2] > scan.vertices[:, 0]).astype(float)[:, np.newaxis]
    extended = extend_over_vertices(fill, side)[:, 0]
    assert (extended == (fill.vertices[:, 2] > fill.vertices[:, 0])).all()


def test_unknown_rim_values_take_no_part() -> None:
    scan = holed_ball()
    fill = cap_holes(scan)
    values = np.full((len(scan.vertices), 2), 5.0)
    values[::2, 0] = np.nan
    values[:, 1] = np.inf
    extended = extend_over_vertices(fill, values)
    assert (extended == [5.0, 0.0]).all()


def test_an_empty_fill_has_no_attributes() -> None:
    scan = holed_ball()
    assert extend_over_vertices(EMPTY, np.ones((len(scan.vertices), 2))).shape == (0, 2)
    assert vertex_normals(scan, EMPTY).shape == (0, 3)
    assert triangle_normals(scan, EMPTY).shape == (0, 3)
    assert nearest_rim_triangle(scan, EMPTY).shape == (0,)
    assert nearest_rim_vertex(scan, EMPTY).shape == (0,)


def test_normals_of_a_flat_cap_are_those_of_the_plane() -> None:
    scan = holed_plane()
    fill = inner_cap(scan)
    assert (triangle_normals(scan, fill) == [0, 0, 1]).all()
    assert (vertex_normals(scan, fill) == [0, 0, 1]).all()


@pytest.mark.parametrize("scale", [1e-200, 1.0, 1e60])
def test_normals_are_unit_vectors_at_any_scale(scale: float) -> None:
    ball = holed_ball()
    scan = Scan(scale * ball.vertices, ball.triangles, "memory")
    normals = vertex_normals(scan, cap_holes(scan))
    lengths = np.linalg.norm(normals, axis=1)
    # Areas below the smallest float64 have no direction left.
    assert ((np.abs(lengths - 1) < 1e-12) | (lengths == 0)).all()
    assert scale < 1e-100 or (lengths > 0).all()


def test_labels_come_from_the_nearest_rim_vertex_and_triangle() -> None:
    scan = holed_plane()
    fill = inner_cap(scan)
    rim = np.unique(fill.triangles[fill.triangles < len(scan.vertices)])
    vertex = nearest_rim_vertex(scan, fill)
    assert set(vertex) <= set(rim)
    found = np.linalg.norm(scan.vertices[vertex] - fill.vertices, axis=1)
    best = np.linalg.norm(scan.vertices[rim][None] - fill.vertices[:, None], axis=2).min(axis=1)
    assert np.allclose(found, best)
    assert np.isin(scan.triangles[nearest_rim_triangle(scan, fill)], rim).any(axis=1).all()


@pytest.mark.parametrize("name", FILES)
def test_colours_that_a_fill_brings_are_written_and_others_are_extended(name: str, tmp_path: Path) -> None:
    mesh = punched(sphere(3), (0, 0, 1), (1, 0, 0), radius=0.4)
    (tmp_path / name).write_bytes(FILES[name](mesh, 128 + 100 * mesh.vertices))
    scan = read_scan(tmp_path / name)
    fill = cap_holes(scan)
    brought = np.random.default_rng(0).integers(0, 256, (len(fill.vertices), 3)).astype(np.float64)
    brought[::5] = np.nan
    found = {}
    for colours in (None, brought):
        path = tmp_path / f"out{'' if colours is None else 's'}{Path(name).suffix}"
        write_scan(path, scan, replace(fill, vertex_colours=colours))
        again = read_scan(path)
        # A binary scene repeats the rim in front of the new vertices.
        new = np.isin(again.vertices.astype("f4"), fill.vertices.astype("f4")).all(axis=1)
        order = np.lexsort(again.vertices[new].T)
        found[colours is None] = colours_of(again)[new][order]
        assert np.abs(colours_of(again)[: len(scan.vertices)] - colours_of(scan)).max() == 0
    expected = brought[np.lexsort(fill.vertices.astype("f4" if name.endswith("glb") else "f8").T)]
    is_brought = np.isfinite(expected).all(axis=1)
    assert np.abs(found[False] - expected)[is_brought].max() < 0.01
    assert (found[False][~is_brought] == found[True][~is_brought]).all()
