from dataclasses import replace

import numpy as np
import pytest

from quadpatch.filling import bridges
from quadpatch.filling.bridged_rims import join_bridges
from quadpatch.filling.bridges import Bridge, make_bridge, make_bridges, ribs_of
from quadpatch.filling.islands import JoinedRims
from quadpatch.mesh.boundary import boundary_edges
from quadpatch.mesh.holes import find_holes
from quadpatch.types import TriangleMesh
from tests.quadpatch.filling.gaps import cut_torus, cut_tube, ends_of, halves, torn_sheet
from tests.quadpatch.shapes import joined, moved, sphere, without


def bridge_of(mesh: TriangleMesh, first: int, second: int) -> Bridge:
    holes = find_holes(mesh)
    made = make_bridge(mesh, holes[first], holes[second], len(mesh.vertices))
    assert isinstance(made, Bridge)
    return made


def test_a_ring_walks_both_loops_whole_and_the_edge_between_them_twice() -> None:
    gap = cut_tube(0.5, 64)
    first, second = ends_of(gap)
    made = make_bridge(gap.mesh, first, second, 0)
    assert isinstance(made, Bridge)
    assert (made.shape, made.ribs) == ("ring", [])
    assert len(made.loop) == first.n_edges + second.n_edges + 2
    edges = np.stack([made.loop, np.roll(made.loop, -1)], axis=1)
    rim = {tuple(edge) for edge in boundary_edges(gap.mesh.triangles).tolist()}
    across = [edge for edge in edges.tolist() if tuple(edge) not in rim]
    assert len(across) == 2
    assert across[0] == across[1][::-1]
    size = np.linalg.norm(np.diff(gap.mesh.vertices[across[0]], axis=0))
    assert size == pytest.approx(made.gap, rel=0.02)


def test_a_strip_runs_along_the_rims_and_the_ribs_at_its_ends() -> None:
    gap = torn_sheet()
    made = bridge_of(gap.mesh, 0, 1)
    assert (made.shape, len(made.ribs)) == ("strip", 2)
    whole = ribs_of([made]).added_to(gap.mesh)
    rim = {tuple(edge) for edge in boundary_edges(whole.triangles).tolist()}
    edges = np.stack([made.loop, np.roll(made.loop, -1)], axis=1).tolist()
    assert all(tuple(edge) in rim for edge in edges)
    assert len(set(made.loop.tolist())) == len(made.loop)
    assert sorted(hole.n_edges for hole in find_holes(whole)) == sorted([len(made.loop), len(rim) - len(made.loop)])


def test_the_vertices_of_several_strips_are_numbered_one_after_the_other() -> None:
    gap = torn_sheet()
    shifted = moved(gap.mesh, (0.0, 0.0, 5.0))
    mesh = joined(gap.mesh, shifted)
    holes = find_holes(mesh)
    low = [hole.id for hole in holes if hole.centre[2] < 2]
    high = [hole.id for hole in holes if hole.centre[2] > 2]
    made, refused = make_bridges(mesh, holes, [(low[0], low[1]), (high[1], high[0])])
    assert not refused
    ribs = ribs_of(made)
    new = np.unique(ribs.triangles[ribs.triangles >= len(mesh.vertices)])
    assert new.tolist() == list(range(len(mesh.vertices), len(mesh.vertices) + len(ribs.vertices)))
    assert ribs.added_to(mesh).vertices[len(mesh.vertices) :].tolist() == ribs.vertices.tolist()


def test_loops_that_can_not_be_joined_are_refused_both() -> None:
    gap = halves(0.4, 3)
    top = gap.mesh.vertices[gap.mesh.triangles].mean(axis=1)[:, 2] > 0.1
    triangles = np.where(top[:, None], gap.mesh.triangles[:, ::-1], gap.mesh.triangles)
    mesh = TriangleMesh(gap.mesh.vertices, triangles)
    made, refused = make_bridges(mesh, find_holes(mesh), [(1, 0)])
    assert not made
    assert {hole: code for hole, (code, _) in refused.items()} == {0: "bridge_flipped", 1: "bridge_flipped"}


def test_a_strip_of_too_many_vertices_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    gap = halves(0.4, 3)
    first, second = ends_of(gap)
    monkeypatch.setattr(bridges, "MAX_NEW_VERTICES", 10)
    made = make_bridge(gap.mesh, first, second, 0)
    assert not isinstance(made, Bridge)
    assert made[0] == "too_many_vertices"


def test_outer_borders_alone_are_joined_along_a_part() -> None:
    gap = torn_sheet()
    first, second = ends_of(gap)
    facing = bridge_of(gap.mesh, 0, 1).facing
    assert bridges.shape_of(facing, first, second) == "strip"
    holes = (replace(first, kind="hole"), replace(second, kind="hole"))
    assert bridges.shape_of(facing, *holes) == "ring"


def test_islands_in_the_gap_are_walked_around_and_others_are_not() -> None:
    gap = halves(0.5, 4)
    whole = sphere(5)

    def disc(place: tuple[float, float, float], scale: float = 1.0) -> TriangleMesh:
        part = without(whole, np.linalg.norm(whole.vertices - np.array(place), axis=1) > 0.15)
        return TriangleMesh(part.vertices * scale, part.triangles)

    inside, above, beside = disc((1.0, 0.0, 0.0)), disc((0.0, 1.0, 0.0), 1.3), disc((0.0, 0.0, -1.0), 1.1)
    turned = disc((0.0, -1.0, 0.0))
    turned = TriangleMesh(turned.vertices, turned.triangles[:, ::-1])
    mesh = joined(gap.mesh, inside, above, beside, turned)
    holes = find_holes(mesh)
    bridge = bridge_of(mesh, 0, 1)
    rims = join_bridges(mesh, holes, JoinedRims([], [], {}), [bridge], {})
    (island,) = rims.host_of
    assert np.allclose(holes[island].centre, (1, 0, 0), atol=0.02)
    assert rims.host_of[island] == 0
    assert len(rims.loops[0]) == len(bridge.loop) + holes[island].n_edges + 2


def test_each_cut_of_a_torus_has_a_bridge_of_its_own() -> None:
    gap = cut_torus(n_around=90)
    holes = find_holes(gap.mesh)
    made, _ = make_bridges(gap.mesh, holes, list(gap.pairs))
    assert [tuple(hole.id for hole in bridge.holes) for bridge in made] == list(gap.pairs)
    rims = join_bridges(gap.mesh, holes, JoinedRims([], [], {}), made, {})
    assert list(rims.bridges) == [hole.id for hole in rims.chosen] == [first for first, _ in gap.pairs]
    assert not set(rims.loops[0]) & set(rims.loops[1])
