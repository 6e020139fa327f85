"""What a user gets for free: two peers, computed on the spot for meshes that the bench has no figures for.

`meshlab_refine` is MeshLab's closing with refinement to the mean edge length. `fair` is the same closing with its new
vertices moved to where a thin plate has least energy, cotangent weights (M. Botsch and L. Kobbelt, "An intuitive
framework for real-time freeform modeling", 2004).
"""

from pathlib import Path
from typing import Any

import numpy as np
import pymeshlab

from benchmarks.quality.bench import Bench, Case, Shape
from benchmarks.quality.results import PEERS, Results
from quadpatch.filling.fairing import THIN_PLATE, fair, triangles_around
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.types import TriangleMesh

# A cotangent Laplacian at the first ring, and that of its neighbours: three rings of triangles around the fill.
_RINGS = 3
# The weights depend on the shape that they shape: taken anew so often, the figures no longer change by a percent.
_ROUNDS = 3
# A loop counts as punched if it lies within so many radii of a hole's centre.
_NEAR = 2.0


def with_peers(bench: Bench, case: Case, results: Results) -> Case:
    """Complete a case with the figures of the peers, where it has none."""
    if case.peers:
        return case
    key = {"mesh": case.shape.name, "radius": case.radius, "sha256": case.shape.sha256}
    found = results.get(PEERS, key, lambda: _measure(bench, case))
    peers = {**case.shape.peers, case.radius: found}
    return Case(Shape(case.shape.name, case.shape.truth, peers), case.radius, case.folder)


def _measure(bench: Bench, case: Case) -> dict[str, Any]:
    punched = bench.read(case.punched)
    closed = close_by_meshlab(punched, longest_punched_loop(punched, case))
    return {
        name: bench.score(case, _written(bench, case.folder / f"{name}.ply", mesh))
        for name, mesh in (("meshlab_refine", closed), ("fair", fair_fill(closed, len(punched.vertices))))
    }


def _written(bench: Bench, path: Path, mesh: TriangleMesh) -> Path:
    bench.write(path, mesh)
    return path


def longest_punched_loop(punched: TriangleMesh, case: Case) -> int:
    """Count the edges of the longest loop that was punched; longer ones are the mesh's own."""
    centres = np.array([hole["centre"] for hole in case.holes()])
    reach = _NEAR * float(case.radius)
    lengths = [0]
    for loop in boundary_loops(punched.triangles).loops:
        off = punched.vertices[loop][:, None] - centres
        if (np.linalg.norm(off, axis=2).min(axis=1) < reach).all():
            lengths.append(len(loop))
    return max(lengths)


def close_by_meshlab(mesh: TriangleMesh, max_edges: int) -> TriangleMesh:
    """Close loops of up to so many edges by MeshLab, refined; the input is a prefix of the output.

    `selfintersection`, MeshLab's default, would leave holes open.
    """
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.triangles))
    meshes.meshing_close_holes(
        # Loops must be shorter than this.
        maxholesize=max_edges + 1,
        # What is refined is what is selected: without this, nothing.
        newfaceselected=True,
        selfintersection=False,
        refinehole=True,
        refineholeedgelen=pymeshlab.PureValue(mean_edge_length(mesh)),
    )
    closed = meshes.current_mesh()
    vertices = np.concatenate([mesh.vertices, closed.vertex_matrix()[len(mesh.vertices) :]])
    return TriangleMesh(vertices, closed.face_matrix().astype(np.int64))


def fair_fill(closed: TriangleMesh, n_measured: int) -> TriangleMesh:
    """Fair all vertices after the first `n_measured` as thin plates; those keep their bits."""
    free = np.arange(len(closed.vertices)) >= n_measured
    near = triangles_around(closed.triangles, np.flatnonzero(free), len(free), _RINGS)
    used, local = np.unique(closed.triangles[near], return_inverse=True)
    triangles, is_free = local.reshape(-1, 3), free[used]
    # A flat fill has useless weights: the graph Laplacian gives it a shape first.
    faired = fair(closed.vertices[used], triangles, is_free, THIN_PLATE, uniform=True)
    for _ in range(_ROUNDS):
        faired = fair(faired, triangles, is_free, THIN_PLATE)
    vertices = closed.vertices.copy()
    vertices[used] = faired
    return TriangleMesh(vertices, closed.triangles)
