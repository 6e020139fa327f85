"""The peers' script, with the peer that this project has as well; what needs MeshLib runs against a stand-in."""

import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from benchmarks.performance import peers
from benchmarks.performance.processes import measure
from benchmarks.performance.programs import MESHLAB, MESHLIB, peer_version
from benchmarks.performance.programs import peers as peers_of
from benchmarks.performance.scans import dome, write_scan
from quadpatch.formats.reading import read_scan
from quadpatch.mesh.boundary import boundary_loops
from tests.waiting import GUARD_S


def test_meshlab_closes_the_holes_and_leaves_the_border(tmp_path: Path) -> None:
    (meshlab,) = [program for program in peers_of(sys.executable) if program.name == MESHLAB]
    write_scan(tmp_path / "in.ply", dome(40_000, 4))
    cost = measure(meshlab.command(tmp_path / "in.ply", tmp_path / "out.ply"), GUARD_S)
    (border,) = boundary_loops(read_scan(tmp_path / "out.ply").triangles).loops
    assert len(border) > 500
    assert cost.peak_mb > 10


def test_a_peer_that_an_environment_lacks_is_left_out() -> None:
    assert peer_version(sys.executable, MESHLAB)
    has_meshlib = bool(peer_version(sys.executable, MESHLIB))
    assert (MESHLIB in [program.name for program in peers_of(sys.executable)]) == has_meshlib
    assert peers_of(None) == []


class Edge(int):
    """An edge of a stand-in topology: rims are runs of numbers, as long as `LENGTHS` says."""

    def sym(self) -> "Edge":
        return self


LENGTHS = {0: 20, 1_000: 600, 5_000: 30}


def _before(edge: Edge) -> Edge:
    start = max(first for first in LENGTHS if first <= edge)
    return Edge(start + (edge - start - 1) % LENGTHS[start])


def test_meshlib_fills_every_rim_but_the_border(monkeypatch: pytest.MonkeyPatch) -> None:
    filled, saved = [], []
    topology = SimpleNamespace(findHoleRepresentiveEdges=lambda: [Edge(start) for start in LENGTHS], prev=_before)
    mesh = SimpleNamespace(averageEdgeLength=lambda: 2.0, topology=topology)

    def settings() -> SimpleNamespace:
        parts = ("triangulateParams", "subdivideSettings", "smoothSettings")
        return SimpleNamespace(**{name: SimpleNamespace() for name in parts})

    def fill(_mesh: object, rim: int, chosen: SimpleNamespace) -> None:
        filled.append((rim, chosen.subdivideSettings.maxEdgeLen, chosen.smoothSettings.vmass))

    library = SimpleNamespace(
        loadMesh=lambda source: mesh,
        saveMesh=lambda mesh, output: saved.append(output),
        FillHoleNicelySettings=settings,
        getUniversalMetric=lambda mesh: "universal",
        EdgeWeights=SimpleNamespace(Unit="unit"),
        VertexMass=SimpleNamespace(NeiArea="area"),
        fillHoleNicely=fill,
    )
    monkeypatch.setitem(sys.modules, "meshlib", SimpleNamespace())
    monkeypatch.setitem(sys.modules, "meshlib.mrmeshpy", library)
    peers.fill_by_meshlib("in.ply", "out.ply")
    assert filled == [(0, 2.8, "area"), (5_000, 2.8, "area")]
    assert saved == ["out.ply"]
