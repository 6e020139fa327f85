"""Two formats that public packages keep meshes in, and that no scanner writes."""

import base64
import gzip
import zlib
from collections.abc import Callable, Mapping
from xml.etree import ElementTree

import numpy as np

from quadpatch.types import TriangleMesh

# Counts at the head of a MuJoCo mesh: vertices, normals, texture coordinates, triangles.
_MSH_HEAD = 4


def read_msh(data: bytes) -> TriangleMesh:
    """Read MuJoCo's binary mesh: four int32 counts, then positions, normals and texture coordinates as float32."""
    n_vertices, n_normals, n_texture, n_triangles = np.frombuffer(data, "<i4", _MSH_HEAD).tolist()
    start = 4 * _MSH_HEAD
    vertices = np.frombuffer(data, "<f4", 3 * n_vertices, start).reshape(-1, 3)
    start += 4 * (3 * n_vertices + 3 * n_normals + 2 * n_texture)
    triangles = np.frombuffer(data, "<i4", 3 * n_triangles, start).reshape(-1, 3)
    return TriangleMesh(vertices.astype(np.float64), triangles.astype(np.int64))


def read_gifti(data: bytes) -> TriangleMesh:
    """Read a GIfTI surface whose arrays are compressed, little-endian, row by row: float32 points, int32 triangles."""
    root = ElementTree.fromstring(gzip.decompress(data) if data[:2] == b"\x1f\x8b" else data)
    arrays = {array.get("Intent"): array for array in root.iter("DataArray")}
    points, triangles = arrays["NIFTI_INTENT_POINTSET"], arrays["NIFTI_INTENT_TRIANGLE"]
    return TriangleMesh(
        np.frombuffer(_content(points), "<f4").reshape(-1, 3).astype(np.float64),
        np.frombuffer(_content(triangles), "<i4").reshape(-1, 3).astype(np.int64),
    )


def _content(array: ElementTree.Element) -> bytes:
    return zlib.decompress(base64.b64decode(array.findtext("Data", "")))


READERS: Mapping[str, Callable[[bytes], TriangleMesh]] = {".msh": read_msh, ".gii": read_gifti}
