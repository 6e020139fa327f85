import os
import signal
from collections.abc import Callable
from concurrent.futures import Future
from functools import cache, partial
from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree

from quadpatch.calibration.energy_selection import EnergyBlend
from quadpatch.errors import ProcessLostError
from quadpatch.filling.fairing import Energy
from quadpatch.filling.fill import ClosedMesh, close_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.parts import FillInParts, surroundings
from quadpatch.processes import ProcessPool
from quadpatch.progress import Fraction
from quadpatch.types import IntArray, TriangleMesh
from tests.quadpatch.filling.fills import all_loops, assert_keeps
from tests.quadpatch.shapes import bumpy_plate, on_surface, punched

BLEND = EnergyBlend((Energy(plate=1.0), Energy(plate=1.0, variation=0.4)), np.zeros(2), np.zeros(2), widest=10.0)


@cache
def with_many_holes(distance: float = 0.6, radius: float = 0.18) -> tuple[TriangleMesh, list[IntArray]]:
    """A plate with round holes in rows, and their rims."""
    at = np.arange(-1.5, 1.51, distance)
    plate = bumpy_plate(160, 4.0)
    mesh = punched(plate, *on_surface(plate, *((float(x), float(y)) for x in at for y in at)), radius=radius)
    *holes, _border = sorted(all_loops(mesh), key=len)
    return mesh, holes


def fill_by(mesh: TriangleMesh, loops: list[IntArray], n_processes: int) -> FilledMesh:
    with ProcessPool(n_processes) as pool:
        filling = FillInParts(mesh, loops, pool)
        filling.begin(BLEND.fill_closed)
        return filling.finish()


def count_and_fill(counts: list[int], closed: ClosedMesh, loops: list[IntArray], reach: Fraction) -> FilledMesh:
    counts.append(len(loops))
    return BLEND.fill_closed(closed, loops, reach)


def test_a_fill_has_the_same_bits_whatever_the_number_of_processes() -> None:
    mesh, loops = with_many_holes()
    alone, *shared = (fill_by(mesh, loops, n) for n in (1, 2, 3))
    assert_keeps(alone, mesh)
    assert alone.unfilled == []
    for other in shared:
        assert other.mesh.vertices.tobytes() == alone.mesh.vertices.tobytes()
        assert other.mesh.triangles.tobytes() == alone.mesh.triangles.tobytes()
        assert other.energy_weights is not None
        assert alone.energy_weights is not None
        assert other.energy_weights.tobytes() == alone.energy_weights.tobytes()


def test_holes_that_helpers_have_closed_meanwhile_are_filled_by_the_same_bits() -> None:
    mesh, loops = with_many_holes()
    alone = fill_by(mesh, loops, 1)
    with ProcessPool(2) as pool:
        filling = FillInParts(mesh, loops, pool)
        # Answered by the only helper once it has closed what was asked for before.
        assert pool.submit(os.getpid).result() == pool.process_ids[0]
        filling.begin(BLEND.fill_closed)
        closed_ahead = filling.finish()
    assert closed_ahead.mesh.vertices.tobytes() == alone.mesh.vertices.tobytes()
    assert closed_ahead.mesh.triangles.tobytes() == alone.mesh.triangles.tobytes()


def test_a_helper_that_is_killed_while_it_closes_holes_is_an_error() -> None:
    mesh, loops = with_many_holes()
    with ProcessPool(2) as pool:
        filling = FillInParts(mesh, loops, pool)
        os.kill(pool.process_ids[0], signal.SIGKILL)
        filling.begin(BLEND.fill_closed)
        with pytest.raises(ProcessLostError):
            filling.finish()


def test_few_parts_are_closed_before_it_is_known_how_to_fill(monkeypatch: pytest.MonkeyPatch) -> None:
    """Closed holes take memory."""
    submitted: list[Callable[..., object]] = []
    mesh, loops = with_many_holes()
    monkeypatch.setattr("quadpatch.filling.parts._PART_WORK", 1_000)
    monkeypatch.setattr("quadpatch.filling.parts._CLOSED_AHEAD", 2)
    with ProcessPool(2) as pool:
        submit = pool.submit

        def counted(function: Callable[..., Any], *arguments: object) -> "Future[Any]":
            submitted.append(function)
            return submit(function, *arguments)

        monkeypatch.setattr(pool, "submit", counted)
        filling = FillInParts(mesh, loops, pool)
        assert submitted == [close_holes] * 2
        filling.begin(BLEND.fill_closed)
        filling.finish()
    assert len(submitted) > 10


@pytest.mark.parametrize(
    ("distance", "largest", "of_weights"), [(0.6, None, 0.01), (0.5, 1.0, 0.01), (0.47, 1.0, 0.05)]
)
def test_parts_are_filled_as_all_at_once_but_for_rounding(
    distance: float, largest: float | None, of_weights: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The unit of lengths in energies is the mean of a part: hence the difference where holes differ in width.

    Rims of large groups that are three edges apart move together where both are let go in one part alone, so other
    weights follow.
    """
    if largest is not None:
        monkeypatch.setattr("quadpatch.filling.parts._LARGEST_GROUP", largest)
    mesh, loops = with_many_holes(distance)
    parts, whole = fill_by(mesh, loops, 1), BLEND.fill(mesh, loops)
    for i in range(len(loops)):
        one, other = (fill.mesh.vertices[fill.n_measured_vertices :][fill.vertex_hole == i] for fill in (parts, whole))
        assert len(one) == len(other)
        assert cKDTree(one).query(other)[0] == pytest.approx(0.0, abs=1e-4)
        assert (parts.triangle_hole == i).sum() == (whole.triangle_hole == i).sum()
    assert parts.energy_weights is not None
    assert whole.energy_weights is not None
    assert np.allclose(parts.energy_weights, whole.energy_weights, atol=of_weights)
    assert np.allclose(parts.disagreement, whole.disagreement, rtol=0.05)


def test_few_holes_are_filled_at_once() -> None:
    mesh, loops = with_many_holes()
    counts: list[int] = []
    with ProcessPool(1) as pool:
        filling = FillInParts(mesh, loops[:5], pool)
        filling.begin(partial(count_and_fill, counts))
        few = filling.finish()
    assert counts == [5]
    assert few.mesh.vertices.tobytes() == BLEND.fill(mesh, loops[:5]).mesh.vertices.tobytes()


@pytest.mark.parametrize(
    ("distance", "largest", "is_one"), [(0.6, None, False), (0.5, None, True), (0.5, 1.0, False), (0.42, 1.0, True)]
)
def test_holes_that_read_each_others_surroundings_are_filled_together(
    distance: float, largest: float | None, is_one: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Large groups are divided, but for holes that are in each other's equations."""
    if largest is not None:
        monkeypatch.setattr("quadpatch.filling.parts._LARGEST_GROUP", largest)
    mesh, loops = with_many_holes(distance)
    counts: list[int] = []
    with ProcessPool(1) as pool:
        filling = FillInParts(mesh, loops, pool)
        filling.begin(partial(count_and_fill, counts))
        filling.finish()
    assert sum(counts) == len(loops)
    assert (max(counts) > 0.9 * len(loops)) == is_one


def test_surroundings_are_all_that_a_fill_reads() -> None:
    mesh, loops = with_many_holes()
    region, local = surroundings(mesh, loops[:7])
    assert len(region.mesh.triangles) < len(mesh.triangles) / 2
    part, whole = BLEND.fill(region.mesh, local), BLEND.fill(mesh, loops[:7])
    assert region.widened(part).mesh.vertices.tobytes() == whole.mesh.vertices.tobytes()
    assert region.widened(part).mesh.triangles.tobytes() == whole.mesh.triangles.tobytes()
