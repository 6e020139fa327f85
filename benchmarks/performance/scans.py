"""Generated scans: a bumpy dome with round holes, and scans of extreme damage.

All are binary PLY files of float32 and int32, as stations send them. The same arguments give the same bytes.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

# Half the width of a dome in mesh units, here millimetres.
_HALF_WIDTH = 500.0
# Holes lie in this part of a dome, away from its border.
_HOLED_PART = 0.9
# Cells across a winding tear, and between its windings.
_STRIP = 3


@dataclass(frozen=True)
class Arrays:
    """Vertices (n, 3) float32 and triangles (m, 3) int32, counter-clockwise seen from outside."""

    vertices: NDArray[np.float32]
    triangles: NDArray[np.int32]


def dome(n_triangles: int, n_holes: int, radius: float = 0.02, seed: int = 0) -> Arrays:
    """Make a bumpy dome over a square with round holes on a lattice.

    Parameters
    ----------
    n_triangles : int
        Of the dome before the holes are cut, about.
    n_holes : int
    radius : float
        Of a hole, as a share of half the dome's width; smaller where the holes would touch.
    seed : int
        Starts the noise, a hundredth of an edge long.
    """
    n = round(np.sqrt(n_triangles / 2)) + 1
    plane = _grid_points(n)
    triangles = _grid_triangles(n)
    per_side = int(np.ceil(np.sqrt(max(n_holes, 1))))
    spacing = 2 * _HOLED_PART / per_side
    centres = (np.arange(per_side) + 0.5) * spacing - _HOLED_PART
    cell = np.clip(((plane + _HOLED_PART) // spacing).astype(np.int64), 0, per_side - 1)
    # Two rows of triangles at least stay between neighbours.
    reach = min(radius, spacing / 2 - 4 / n)
    is_cut = (np.square(plane - centres[cell]).sum(axis=1) < reach**2) & (cell @ [per_side, 1] < n_holes)
    return _used(_lifted(plane, n, seed), triangles[~is_cut[triangles].any(axis=1)])


def three_edge_holes(n_holes: int, seed: int = 0) -> Arrays:
    """Make a dome without `n_holes` single triangles, no two of which share a corner."""
    per_side = int(np.ceil(np.sqrt(n_holes)))
    n = 3 * per_side + 2
    cells = np.arange(per_side) * 3 + 1
    cut = (cells[:, np.newaxis] * (n - 1) + cells).ravel()[:n_holes]
    return Arrays(_lifted(_grid_points(n), n, seed), np.delete(_grid_triangles(n), cut, axis=0))


def loose_pieces(n_pieces: int, seed: int = 0) -> Arrays:
    """Make a dome with twenty holes, and single triangles in a layer above it that touch nothing."""
    body = dome(100_000, 20, seed=seed)
    rng = np.random.default_rng(seed)
    per_side = int(np.ceil(np.sqrt(n_pieces)))
    rows, columns = np.divmod(np.arange(n_pieces), per_side)
    corners = np.stack([columns, rows, np.full(n_pieces, per_side)], axis=1)[:, np.newaxis] + 0.1
    corners = corners + np.array([[0.0, 0, 0], [0.6, 0, 0], [0, 0.6, 0]]) + rng.uniform(0, 0.2, (n_pieces, 3, 3))
    pieces = (corners * (2 / per_side) - [1, 1, 1]) * _HALF_WIDTH
    return Arrays(
        np.concatenate([body.vertices, pieces.reshape(-1, 3).astype(np.float32)]),
        np.concatenate([body.triangles, len(body.vertices) + np.arange(3 * n_pieces, dtype=np.int32).reshape(-1, 3)]),
    )


def long_rim(n_edges: int, seed: int = 0) -> Arrays:
    """Make a dome with one tear that winds to and fro, whose rim has about `n_edges` edges.

    It is a strip of three cells, as far from its next winding, over a square a bit less than a quarter as wide as the
    dome: a round hole of so long a rim would need a scan of a billion triangles around it.
    """
    width = round(np.sqrt(_STRIP * n_edges) / (2 * _STRIP)) * 2 * _STRIP + _STRIP
    n = round(4.2 * width) + 1
    row, column = np.divmod(np.arange((n - 1) ** 2), n - 1)
    row, column = row - (n - width) // 2, column - (n - width) // 2
    strip = row // _STRIP
    # Every second strip is open; the ones between are so at their end, the left and the right one in turn.
    at_end = np.where(strip % 4 == 1, column < _STRIP, column >= width - _STRIP)
    is_inside = (row >= 0) & (row < width) & (column >= 0) & (column < width)
    is_torn = is_inside & ((strip % 2 == 0) | at_end)
    return _used(_lifted(_grid_points(n), n, seed), _grid_triangles(n)[~np.tile(is_torn, 2)])


def write_scan(path: Path, scan: Arrays) -> None:
    """Write a binary PLY file."""
    rows = np.zeros(len(scan.triangles), [("n", "u1"), ("corners", "<i4", 3)])
    rows["n"], rows["corners"] = 3, scan.triangles
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(scan.vertices)}\n"
    header += "".join(f"property float {axis}\n" for axis in "xyz")
    header += f"element face {len(rows)}\nproperty list uchar int vertex_indices\nend_header\n"
    with path.open("wb") as file:
        file.write(header.encode())
        file.write(scan.vertices.astype("<f4").tobytes())
        file.write(rows.tobytes())


def _grid_points(n: int) -> NDArray[np.float64]:
    """Places (n * n, 2) on the square from -1 to 1."""
    side = np.linspace(-1, 1, n)
    return np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)


def _grid_triangles(n: int) -> NDArray[np.int32]:
    """Two triangles for each cell of a grid, the first ones first: (2 (n - 1)^2, 3)."""
    index = np.arange(n * n, dtype=np.int32).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def _lifted(plane: NDArray[np.float64], n: int, seed: int) -> NDArray[np.float32]:
    x, y = plane.T
    z = 0.5 * np.exp(-(x**2) - y**2) + 0.01 * np.sin(25 * x) * np.cos(23 * y) + 0.02 * np.sin(7 * x + 3 * y)
    z += np.random.default_rng(seed).normal(0, 0.02 / n, len(z))
    return np.asarray(np.stack([x, y, z], axis=1) * _HALF_WIDTH, np.float32)


def _used(vertices: NDArray[np.float32], triangles: NDArray[np.int32]) -> Arrays:
    """Leave out vertices that no triangle uses."""
    is_used = np.zeros(len(vertices), bool)
    is_used[triangles] = True
    return Arrays(vertices[is_used], (np.cumsum(is_used, dtype=np.int32) - 1)[triangles].astype(np.int32))
