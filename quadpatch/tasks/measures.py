"""What reports of encoded meshes count.

Tested in `tests/quadpatch/tasks/test_encode.py`.
"""

from typing import Any

import numpy as np

from quadpatch.compression.content import QpzContent
from quadpatch.compression.subdivision import subdivide
from quadpatch.formats.scan import Scan


def corrected_patches(content: QpzContent) -> int:
    """Count the patches with a corrected grid vertex."""
    quads = np.array(content.walk.polygons, np.int64).reshape(-1, 4)
    grid = subdivide(quads, len(content.places), content.levels).grid
    return int(np.isin(grid.reshape(len(grid), -1), content.corrected).any(axis=1).sum())


def entities(scan: Scan, content: QpzContent) -> dict[str, Any]:
    """Count numbers of the mesh and of the file, and their ratios.

    `entity_factor` is the paper's count: coordinates of the mesh's vertices, three each, by what is stored in their
    place: coordinates of the quad mesh's vertices, non-zero coefficients, and here corrections, moved border vertices
    (three numbers each), the cells left out and the coordinates of triangles that are stored as they are. Indices and
    the dictionary, which the paper shares among meshes, are not counted there; `entity_factor_with_indices` counts
    corners of triangles and quads, the place of every coefficient, correction and moved vertex, and the numbers of a
    dictionary that stands in the file.
    """
    moved = int(content.border_moves.any(axis=1).sum())
    nonzero, corrections = int(np.count_nonzero(content.codes)), len(content.corrected)
    pieces = content.pieces
    stored = 3 * len(content.places) + nonzero + corrections + 3 * moved + len(content.removed) + pieces.places.size
    indices = 4 * len(content.walk.polygons) + nonzero + corrections + moved + 3 * len(pieces.walk.polygons)
    if content.embedded is not None:
        indices += int(np.count_nonzero(content.embedded.coefficients))
    if content.kept is not None:
        stored += content.kept.place.size
        indices += len(content.kept.patch) + content.kept.triangles.size
    coordinates, corners = 3 * len(scan.vertices), 3 * len(scan.triangles)
    return {
        "entities": {"mesh": coordinates, "file": stored},
        "entity_factor": coordinates / stored,
        "entity_factor_with_indices": (coordinates + corners) / (stored + indices),
    }
