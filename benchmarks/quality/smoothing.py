"""Smoothed meshes that are kept: the paper's smoothing is most of the time of its recipe, and always gives the same.

MeshLab's two steps take one to three minutes for each mesh of the bench. The experiments smooth the same few meshes
again for every dictionary, network and patch length.
"""

import hashlib
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from unittest.mock import patch

import numpy as np

from quadpatch.mesh.meshlab import two_step_smooth
from quadpatch.types import TriangleMesh


@contextmanager
def kept_smoothing(folder: Path) -> Iterator[None]:
    """Have the paper's smoothing look into a folder first, within the block; files are named by the mesh's hash."""

    def smooth(mesh: TriangleMesh, n_iterations: int) -> TriangleMesh:
        data = mesh.vertices.tobytes() + mesh.triangles.tobytes()
        path = folder / f"{hashlib.sha256(data).hexdigest()}_{n_iterations}.npy"
        if not path.is_file():
            folder.mkdir(parents=True, exist_ok=True)
            # Another process may smooth the same mesh.
            partial = path.with_suffix(f".{os.getpid()}.npy")
            np.save(partial, two_step_smooth(mesh, n_iterations).vertices)
            partial.replace(path)
        return TriangleMesh(np.load(path), mesh.triangles)

    with patch("quadpatch.patches.paper_layout.two_step_smooth", smooth):
        yield
