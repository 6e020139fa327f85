from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from benchmarks.performance.scans import Arrays, dome, long_rim, loose_pieces, three_edge_holes, write_scan
from quadpatch.formats.reading import read_scan
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.topology import face_components
from quadpatch.types import IntArray
from tests.quadpatch.shapes import is_oriented_manifold


def loops(scan: Arrays) -> list[IntArray]:
    return boundary_loops(scan.triangles.astype(np.int64)).loops


def rims(scan: Arrays) -> list[int]:
    """Edges of all boundary loops, the border of the dome last: it is the longest."""
    return sorted(len(loop) for loop in loops(scan))


@pytest.mark.parametrize("n_holes", [1, 20, 37])
def test_a_dome_has_the_holes_and_about_the_triangles_that_were_asked_for(n_holes: int) -> None:
    scan = dome(30_000, n_holes, 0.05)
    *holes, border = rims(scan)
    assert len(holes) == n_holes
    assert 0.85 * 30_000 < len(scan.triangles) <= 30_200
    assert border > 400
    assert min(holes) > 10
    assert is_oriented_manifold(scan.triangles.astype(np.int64))
    assert set(scan.triangles.ravel().tolist()) == set(range(len(scan.vertices)))


def test_holes_that_would_touch_are_made_smaller() -> None:
    assert len(rims(dome(40_000, 400, 0.2))) == 401


def test_single_triangles_are_missing() -> None:
    counts = Counter(rims(three_edge_holes(50)))
    assert counts[3] == 50
    assert sum(counts.values()) == 51


def test_loose_pieces_are_pieces_of_their_own() -> None:
    scan = loose_pieces(300)
    counts = Counter(np.bincount(face_components(scan.triangles.astype(np.int64), len(scan.vertices))).tolist())
    assert counts[1] == 300
    assert sum(counts.values()) == 301
    assert Counter(rims(scan))[3] == 300


def test_a_long_rim_is_one_rim_and_narrower_than_a_quarter_of_the_scan() -> None:
    scan = long_rim(3_000)
    tear, border = sorted(loops(scan), key=lambda loop: np.ptp(scan.vertices[loop]))
    assert 2_500 < len(tear) < 3_600
    assert np.ptp(scan.vertices[tear, :2], axis=0).max() < 0.25 * np.ptp(scan.vertices[border, :2], axis=0).max()
    assert is_oriented_manifold(scan.triangles.astype(np.int64))


def test_a_file_holds_single_precision_and_comes_back_as_it_was(tmp_path: Path) -> None:
    scan = dome(2_000, 3)
    write_scan(tmp_path / "a.ply", scan)
    write_scan(tmp_path / "b.ply", dome(2_000, 3))
    read = read_scan(tmp_path / "a.ply")
    assert (read.vertices.astype(np.float32) == scan.vertices).all()
    assert (read.triangles == scan.triangles).all()
    assert (tmp_path / "a.ply").read_bytes() == (tmp_path / "b.ply").read_bytes()
    assert (tmp_path / "a.ply").stat().st_size < 12 * len(scan.vertices) + 13 * len(scan.triangles) + 300
