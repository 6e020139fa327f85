"""Datasets brought to one size and one resolution, as the paper does before it cuts patches.

A mesh is moved and scaled so that its longest side is 1, then brought to a common edge length: by quadric edge collapse
where it is finer, by splitting long edges at their midpoints where it is coarser.
"""

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np

from quadpatch.errors import EmptyMeshError, OptionError
from quadpatch.mesh.measures import longest_side, mean_edge_length, surface_area
from quadpatch.mesh.meshlab import collapse_edges, split_edges, write_ply
from quadpatch.progress import Progress, no_progress
from quadpatch.quads.vertex_clustering import split_fans
from quadpatch.types import TriangleMesh
from training.corpus import read_mesh
from training.sources import MANIFEST, Source

# Edges this much longer than the common one are split; their halves are as much shorter, and the mean is nearly kept.
LONGEST_EDGE = 4 / 3


def normalised(mesh: TriangleMesh, edge_length: float) -> TriangleMesh:
    """Bring a mesh into the unit cube and to a mean edge length.

    Parameters
    ----------
    mesh : TriangleMesh
    edge_length : float
        Wanted, as a share of the longest side.

    Returns
    -------
    TriangleMesh
        Its longest side is 1, its lowest corner 0.

    Raises
    ------
    EmptyMeshError
        If the mesh has no extent.
    """
    size = longest_side(mesh)
    if not size > 0:
        raise EmptyMeshError("the mesh has no extent")
    # Cut where it is not a manifold: such edges can't be split.
    original, triangles = split_fans(mesh.triangles)
    vertices = mesh.vertices[original]
    unit = TriangleMesh((vertices - vertices.min(axis=0)) / size, triangles)
    split = split_edges(unit, LONGEST_EDGE * edge_length)
    # An even triangle of that side has this area.
    n_wanted = max(4, round(surface_area(split) / (np.sqrt(3) / 4 * edge_length**2)))
    return collapse_edges(split, n_wanted) if mean_edge_length(split) < edge_length else split


def read_normalised(path: Path, edge_length: float | None) -> TriangleMesh:
    """Read a training mesh; with an edge length, a share of the longest side, it is normalised. Raises MeshError."""
    mesh = read_mesh(path)
    return mesh if edge_length is None else normalised(mesh, edge_length)


def normalise_dataset(
    sources: list[Source], edge_length: float, folder: Path, progress: Progress = no_progress
) -> list[Path]:
    """Write normalised copies of meshes as PLY, with a manifest that keeps their licences and says where they are from.

    Parameters
    ----------
    sources : list of Source
    edge_length : float
        As a share of the longest side.
    folder : Path
        Empty, or made.
    progress : callable

    Raises
    ------
    OptionError
        If the folder is not empty, or two meshes have one name.
    MeshError
        If a mesh can't be read.
    """
    folder.mkdir(parents=True, exist_ok=True)
    if any(folder.iterdir()):
        raise OptionError(f"{folder} is not empty")
    if len({source.name for source in sources}) < len(sources):
        raise OptionError("two of the meshes have the same name")
    written = []
    for done, source in enumerate(sources):
        progress(source.name, done / len(sources))
        path = folder / f"{source.name}.ply"
        write_ply(read_normalised(source.path, edge_length), path)
        written.append(path)
    entries = [{**asdict(source), "path": source.path.name, "edge_length": edge_length} for source in sources]
    (folder / MANIFEST).write_text(json.dumps(entries, indent=1) + "\n", "utf-8")
    progress("", 1.0)
    return written
