"""Shapes with noise along their normals."""

from collections.abc import Callable

import numpy as np

from quadpatch.mesh.measures import mean_edge_length
from quadpatch.mesh.normals import triangle_normals, vertex_normals
from quadpatch.types import TriangleMesh, Vertices
from tests.quadpatch.shapes import cylinder, open_grid, relief, sphere


def with_noise(mesh: TriangleMesh, noise: float, seed: int = 0) -> tuple[TriangleMesh, float]:
    """Move vertices along their normals; the noise is given in mean edges, and handed back in mesh units."""
    size = noise * mean_edge_length(mesh)
    shift = size * np.random.default_rng(seed).normal(size=(len(mesh.vertices), 1))
    return TriangleMesh(mesh.vertices + shift * vertex_normals(mesh.vertices, mesh.triangles), mesh.triangles), size


def roof(n: int) -> TriangleMesh:
    """Two planes that meet at a right angle."""
    flat = open_grid(n)
    vertices = flat.vertices.copy()
    middle = vertices[:, 0].min() + np.ptp(vertices[:, 0]) / 2
    vertices[:, 2] = -np.abs(vertices[:, 0] - middle)
    return TriangleMesh(vertices, flat.triangles)


def normal_error(clean: TriangleMesh, vertices: Vertices) -> float:
    """Mean angle between the normals of triangles, in degrees."""
    cosines = (triangle_normals(clean.vertices, clean.triangles) * triangle_normals(vertices, clean.triangles)).sum(1)
    return float(np.degrees(np.arccos(np.clip(cosines, -1, 1))).mean())


SHAPES: dict[str, Callable[[], TriangleMesh]] = {
    "sphere": lambda: sphere(3),
    "cylinder": lambda: cylinder(40, 30),
    "roof": lambda: roof(40),
    "relief": lambda: relief(100, waves=5),
}
