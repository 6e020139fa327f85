"""Small whole meshes, to be damaged."""

import numpy as np

from quadpatch.types import TriangleMesh
from tests.quadpatch.faulty_shapes import sheet_with_crack, sheet_with_round_hole
from tests.quadpatch.shapes import bumpy_plate, cylinder, open_grid, relief, sphere


def any_base(rng: np.random.Generator) -> TriangleMesh:
    """Draw a sphere, a torus, an open grid, a tube or a bumpy plate of 600 to 1,300 triangles, about 2 units wide."""
    builders = (
        lambda: sphere(3),
        lambda: torus(int(rng.integers(26, 40)), int(rng.integers(12, 16))),
        lambda: open_grid(int(rng.integers(18, 25)), 2.0),
        lambda: cylinder(int(rng.integers(18, 26)), int(rng.integers(16, 24)), 0.5, 2.0),
        lambda: bumpy_plate(int(rng.integers(18, 25)), 2.0, int(rng.integers(1000))),
        lambda: relief(int(rng.integers(20, 25)), 2.0, float(rng.uniform(0.02, 0.15)), 3),
    )
    return builders[int(rng.integers(len(builders)))]()


def with_long_rim(rng: np.random.Generator) -> TriangleMesh:
    """Draw a sheet with a round hole or a crack of more than 128 edges."""
    if rng.random() < 0.4:
        return sheet_with_crack(int(rng.integers(70, 90)))
    radius = float(rng.uniform(20, 24))
    return sheet_with_round_hole(radius, float(rng.choice([0.0, 2.5 * radius])))


def torus(n_around: int, n_across: int) -> TriangleMesh:
    """Build a torus of radii 0.7 and 0.3 around the z axis, normals outwards."""
    u, v = (part.ravel() for part in np.meshgrid(np.arange(n_around), np.arange(n_across), indexing="ij"))
    index = np.arange(n_around * n_across).reshape(n_around, n_across)
    along, across = np.roll(index, -1, axis=0), np.roll(index, -1, axis=1)
    corner = np.roll(along, -1, axis=1)
    a, b, c, d = (part.ravel() for part in (index, along, corner, across))
    alpha, beta = 2 * np.pi * u / n_around, 2 * np.pi * v / n_across
    radius = 0.7 + 0.3 * np.cos(beta)
    vertices = np.stack([radius * np.cos(alpha), radius * np.sin(alpha), 0.3 * np.sin(beta)], axis=1)
    return TriangleMesh(vertices, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]))
