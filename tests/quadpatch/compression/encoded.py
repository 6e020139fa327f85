"""Small files for tests, made once."""

from functools import cache

import numpy as np

from quadpatch.compression.candidate import DictionaryChoice
from quadpatch.compression.content import COSINE, SELF
from quadpatch.compression.encode import EncodeOptions, Encoding, encode_mesh
from quadpatch.stages import Stages
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import relief, sphere


def surface(name: str) -> TriangleMesh:
    """A closed surface, or an open one with detail."""
    return sphere(3) if name == "sphere" else relief(24, waves=3)


def max_error_of(mesh: TriangleMesh) -> float:
    return 0.004 * float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))


@cache
def encoded(name: str, keep_connectivity: bool = False, kind: str = COSINE) -> Encoding:
    mesh = surface(name)
    choice = DictionaryChoice((SELF,) if kind == SELF else (COSINE,))
    return encode_mesh(mesh, choice, EncodeOptions(max_error_of(mesh), keep_connectivity), Stages())
