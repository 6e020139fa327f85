import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.filling.bridge_proposals import BridgeProposal, propose_bridges
from quadpatch.filling.islands import hosts_of
from quadpatch.mesh.holes import find_holes
from quadpatch.types import TriangleMesh
from tests.quadpatch.filling.gaps import Gap, cut_torus, cut_tube, halves, torn_sheet, torn_sphere
from tests.quadpatch.shapes import (
    cylinder,
    flipped,
    joined,
    moved,
    open_grid,
    plate_with_disc,
    plate_with_window,
    punched,
    sphere,
    without,
)


def proposals(mesh: TriangleMesh) -> list[BridgeProposal]:
    holes = find_holes(mesh)
    return propose_bridges(mesh, holes, hosts_of(mesh, holes, [hole for hole in holes if hole.is_manifold]))


@pytest.mark.parametrize(
    ("gap", "shape"),
    [
        (halves(0.2), "ring"),
        (halves(0.6), "ring"),
        (torn_sphere(), "ring"),
        (torn_sphere(seed=1), "ring"),
        (cut_torus(), "ring"),
        (cut_tube(0.1), "ring"),
        (cut_tube(1.0, 64), "ring"),
        (torn_sheet(), "strip"),
    ],
)
def test_loops_that_face_each_other_are_proposed_and_no_others(gap: Gap, shape: str) -> None:
    found = proposals(gap.mesh)
    assert {frozenset(proposal.holes) for proposal in found} == {frozenset(pair) for pair in gap.pairs}
    for proposal in found:
        assert proposal.shape == shape
        assert proposal.gap == pytest.approx(gap.width, rel=0.35, abs=0.1)
        assert 0 < proposal.share <= 1


HALVES = halves(0.3, 4).mesh
TOP = HALVES.vertices[HALVES.triangles].mean(axis=1)[:, 2] > 0.1


@pytest.mark.parametrize(
    "mesh",
    [
        cylinder(24, 20),
        cylinder(24, 2, length=0.2),
        sphere(3),
        punched(sphere(4), (0, 0, 1), (0, 0, -1), (1, 0, 0), radius=0.3),
        punched(open_grid(31), (-3, 0, 0), (3, 0, 0), radius=2.4),
        joined(open_grid(9), moved(open_grid(9), (0, 0, 1.0))),
        joined(plate_with_disc(24), flipped(moved(plate_with_disc(24), (0, 0, 0.2)))),
        joined(plate_with_window(12, 2), moved(open_grid(4), (0.0, 0.0, 0.1))),
        TriangleMesh(HALVES.vertices, np.where(TOP[:, None], HALVES.triangles[:, ::-1], HALVES.triangles)),
        joined(cylinder(24, 20), moved(cylinder(24, 20), (0, 0, 9.0))),
        joined(cylinder(24, 20), moved(cylinder(24, 20), (2.5, 0, 0))),
        without(sphere(4), np.zeros(2562, bool)),
    ],
    ids=[
        "open tube",
        "band",
        "closed",
        "three holes",
        "two holes side by side",
        "sheets one above the other",
        "a hole through a plate",
        "an island",
        "halves turned against each other",
        "tubes far apart",
        "tubes side by side",
        "no loop",
    ],
)
def test_loops_that_do_not_face_each_other_are_not_proposed(mesh: TriangleMesh) -> None:
    assert proposals(mesh) == []


def test_each_loop_is_proposed_once_with_the_nearest_other_one() -> None:
    tubes = [moved(cylinder(24, 6, length=1.0), (0.0, 0.0, z)) for z in (0.0, 1.2, 2.6)]
    mesh = joined(*tubes)
    found = proposals(mesh)
    ids = [i for proposal in found for i in proposal.holes]
    assert len(found) == 2
    assert len(set(ids)) == 4
    assert sorted(round(proposal.gap, 2) for proposal in found) == [0.2, 0.4]


@settings(max_examples=10)
@given(scale=st.sampled_from([1e-6, 1.0, 1e6]), seed=st.integers(0, 9))
def test_proposals_do_not_depend_on_size_and_numbering(scale: float, seed: int) -> None:
    gap = halves(0.3, 3)
    order = np.random.default_rng(seed).permutation(len(gap.mesh.vertices))
    number = np.argsort(order)
    mesh = TriangleMesh(gap.mesh.vertices[order] * scale, number[gap.mesh.triangles])
    (one,), (other,) = proposals(gap.mesh), proposals(mesh)
    assert other.holes == one.holes
    assert other.gap == pytest.approx(scale * one.gap, rel=0.05)
