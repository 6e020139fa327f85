"""Fills the holes of a file with a peer, in the environment that has it; runs as a script there.

Usage: peers.py meshlib|meshlab IN OUT, or peers.py version meshlib|pymeshlab. MeshLib's licence allows no commercial
use, so it is no dependency of this project.

MeshLib fills, subdivides to the density around, and smooths the curvature; MeshLab closes holes by the smallest
triangles, neither refined nor faired. Both leave the border of the scan open.

Tested in `tests/benchmarks/performance/test_peers.py`.
"""

import importlib
import importlib.metadata
import sys
from collections.abc import Callable
from typing import Any

# Holes of the generated domes have fewer edges, their borders more. MeshLab has such a limit; for MeshLib the longest
# rim is left open where it is longer.
_MOST_EDGES = 500
# Of MeshLib: an edge of the fill may be this many mean edges long, and be split so many times in all.
_EDGE_SHARE = 1.4
_MOST_SPLITS = 20_000


def fill_by_meshlib(source: str, output: str) -> None:
    """Fill every hole but the border."""
    library: Any = importlib.import_module("meshlib.mrmeshpy")
    mesh = library.loadMesh(source)
    edge_length = mesh.averageEdgeLength()
    rims = list(mesh.topology.findHoleRepresentiveEdges())
    counts = [_count(mesh.topology, rim) for rim in rims]
    border = counts.index(max(counts)) if counts and max(counts) > _MOST_EDGES else None
    for i, rim in enumerate(rims):
        if i != border:
            library.fillHoleNicely(mesh, rim, _settings(library, mesh, edge_length))
    library.saveMesh(mesh, output)


def _settings(library: Any, mesh: Any, edge_length: float) -> Any:
    settings = library.FillHoleNicelySettings()
    settings.triangulateParams.metric = library.getUniversalMetric(mesh)
    settings.triangulateOnly = False
    settings.smoothCurvature = True
    settings.subdivideSettings.maxEdgeLen = _EDGE_SHARE * edge_length
    settings.subdivideSettings.maxEdgeSplits = _MOST_SPLITS
    settings.smoothSettings.edgeWeights = library.EdgeWeights.Unit
    settings.smoothSettings.vmass = library.VertexMass.NeiArea
    return settings


def _count(topology: Any, rim: Any) -> int:
    """Count the edges of a rim."""
    count, edge = 1, topology.prev(rim.sym())
    while edge != rim:
        count, edge = count + 1, topology.prev(edge.sym())
    return count


def fill_by_meshlab(source: str, output: str) -> None:
    """Close every hole of up to five hundred edges."""
    library: Any = importlib.import_module("pymeshlab")
    meshes = library.MeshSet(verbose=False)
    meshes.load_new_mesh(source)
    meshes.meshing_close_holes(maxholesize=_MOST_EDGES, refinehole=False, selfintersection=False)
    meshes.save_current_mesh(output)


def print_version(package: str) -> None:
    """Print the version of a package, and nothing where it is not installed."""
    try:
        sys.stdout.write(importlib.metadata.version(package))
    except importlib.metadata.PackageNotFoundError:
        return


_COMMANDS: dict[str, Callable[..., None]] = {
    "meshlib": fill_by_meshlib,
    "meshlab": fill_by_meshlab,
    "version": print_version,
}

if __name__ == "__main__":
    _COMMANDS[sys.argv[1]](*sys.argv[2:])
