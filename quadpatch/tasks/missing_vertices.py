"""Which vertices of a file are missing: by NaN, by a property of the file, or by a list in a file of its own.

A list is text (whole numbers between blanks, line ends or commas), JSON (an array of whole numbers) or a NumPy file
(`.npy`: whole numbers, or one boolean for each vertex). Vertices are counted from 0, in the order of the mesh file.
"""

import io
import json
from pathlib import Path

import numpy as np

from quadpatch.errors import NotFiniteError, OptionError
from quadpatch.formats.scan import Scan
from quadpatch.formats.vertex_properties import vertex_mask
from quadpatch.types import BoolArray, IntArray

NAN = "nan"
PROPERTY = "property:"

# A number of a list takes a few bytes; a longer file is none for this mesh.
_BYTES_PER_VERTEX = 64
_MOST_OVERHEAD = 4096
_MOST_HEADER = 2000


def missing_vertices(scan: Scan, missing: str | Path) -> BoolArray:
    """Find the missing vertices of a scan.

    Parameters
    ----------
    scan : Scan
        Read with missing vertices allowed.
    missing : str or Path
        `nan`, `property:NAME` (vertices where that property of a PLY file is not 0), or the path of a list.

    Returns
    -------
    (n,) bool

    Raises
    ------
    OptionError
        If there is no such property or list, it does not fit the mesh, or no vertex is missing, or all are.
    NotFiniteError
        If vertices without a position are not among the missing ones.
    """
    is_nan = np.isnan(scan.vertices).any(axis=1)
    if missing == NAN:
        marked = is_nan
    elif isinstance(missing, str) and missing.startswith(PROPERTY):
        marked = vertex_mask(scan, missing.removeprefix(PROPERTY))
    else:
        marked = _listed(Path(missing), len(scan.vertices))
    if not marked.any():
        raise OptionError("no vertex is missing: there is nothing to restore")
    if marked.all():
        raise OptionError("all vertices are missing: there is nothing to restore them from")
    lost = is_nan & ~marked
    if lost.any():
        raise NotFiniteError(
            f"{int(lost.sum()):,} vertices have no position and are not marked as missing, vertex "
            f"{int(np.argmax(lost))} first"
        )
    return np.asarray(marked, np.bool_)


def _listed(path: Path, n_vertices: int) -> BoolArray:
    """Read a list of vertices as a mask (n_vertices,)."""
    limit = _BYTES_PER_VERTEX * n_vertices + _MOST_OVERHEAD
    try:
        n_bytes = path.stat().st_size
        if n_bytes > limit:
            raise OptionError(f"{path.name} has {n_bytes:,} bytes; a list for this mesh has at most {limit:,}")
        data = path.read_bytes()
    except OSError as error:
        raise OptionError(f"the list of missing vertices {path.name} can't be read: {error.strerror}") from error
    found = _from_npy(data, path.name) if data.startswith(np.lib.format.MAGIC_PREFIX) else _from_text(data, path.name)
    if found.dtype == np.bool_:
        if len(found) != n_vertices:
            raise OptionError(f"{path.name} has {len(found):,} booleans; the mesh has {n_vertices:,} vertices")
        return np.asarray(found, np.bool_)
    beyond = (found < 0) | (found >= n_vertices)
    if beyond.any():
        first = int(found[np.argmax(beyond)])
        raise OptionError(f"{path.name} names vertex {first}; the mesh has vertices 0 to {n_vertices - 1}")
    mask = np.zeros(n_vertices, np.bool_)
    mask[found.astype(np.int64)] = True
    return mask


def _from_text(data: bytes, name: str) -> IntArray:
    try:
        text = data.decode()
        numbers = json.loads(text) if text.lstrip()[:1] == "[" else [int(w) for w in text.replace(",", " ").split()]
        if not all(isinstance(number, int) and not isinstance(number, bool) for number in numbers):
            raise OptionError(f"{name} must list whole numbers")
        return np.array(numbers, np.int64)
    except (ValueError, OverflowError, RecursionError) as error:
        raise OptionError(f"{name} is no list of whole numbers") from error


def _from_npy(data: bytes, name: str) -> "IntArray | BoolArray":
    """Read an array without trusting what its header says of its size."""
    stream = io.BytesIO(data)
    try:
        version = np.lib.format.read_magic(stream)
        read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, _, dtype = read(stream, max_header_size=_MOST_HEADER)
    except (ValueError, EOFError, SyntaxError) as error:
        raise OptionError(f"{name} is no NumPy file") from error
    if len(shape) != 1 or dtype.kind not in "iub":
        raise OptionError(f"{name} holds {dtype} of shape {shape}; it must hold whole numbers or booleans in one row")
    values = data[stream.tell() :]
    if len(values) != shape[0] * dtype.itemsize:
        raise OptionError(f"{name} is cut off: it says {shape[0]:,} numbers and holds {len(values):,} bytes")
    return np.frombuffer(values, dtype)
