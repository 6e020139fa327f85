"""Arrays of a glTF document, checked before a byte of them is touched.

Tested in `tests/quadpatch/formats/gltf/test_reader.py`.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadpatch.errors import FormatError, ReadError
from quadpatch.formats.gltf.container import GltfFile
from quadpatch.formats.limits import ReadLimits

_COMPONENTS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def get_entry(owner: dict[str, Any], name: str, index: object) -> dict[str, Any]:
    """Look up an entry of one of the document's lists.

    Raises
    ------
    ReadError
        If there is no such entry, or it is no object.
    """
    listed = owner.get(name)
    if not isinstance(index, int) or isinstance(index, bool) or not isinstance(listed, list):
        raise ReadError(f"the glTF document names {name} {str(index)[:40]!r}, but has no such list or number")
    if not 0 <= index < len(listed) or not isinstance(listed[index], dict):
        raise ReadError(f"the glTF document names {name} {index}; there are {len(listed)}")
    entry: dict[str, Any] = listed[index]
    return entry


def get_count(entry: dict[str, Any], key: str, default: int | None = None) -> int:
    """Return a number that must be a whole one and not negative."""
    value = entry.get(key, default)
    if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value < 2**48:
        raise ReadError(f"the glTF document has {key} = {str(value)[:40]!r} where a count belongs")
    return value


def get_list(entry: dict[str, Any], key: str) -> list[Any]:
    """Return a list, empty where there is none."""
    value = entry.get(key, [])
    if not isinstance(value, list):
        raise ReadError(f"the glTF document has a {key} that is no list")
    return value


def get_object(entry: dict[str, Any], key: str) -> dict[str, Any]:
    """Return an object, empty where there is none."""
    value = entry.get(key, {})
    if not isinstance(value, dict):
        raise ReadError(f"the glTF document has a {key} that is no object")
    return value


def read_accessor(file: GltfFile, index: object, width: tuple[int, ...], limits: ReadLimits) -> NDArray[Any]:
    """Read one array.

    Parameters
    ----------
    file : GltfFile
    index : object
        What the document names as the number of the accessor.
    width : tuple of int
        Allowed numbers of components.
    limits : ReadLimits

    Returns
    -------
    (count, width)
        In the stored type; normalised integers as float64 in 0..1 or -1..1.
    """
    accessor = get_entry(file.document, "accessors", index)
    count = get_count(accessor, "count")
    limits.check_vertices(count // 3)
    n_components = _WIDTHS.get(str(accessor.get("type")), 0)
    if n_components not in width:
        raise ReadError(f"glTF accessor {index} is a {str(accessor.get('type'))[:20]}, which does not belong there")
    code = _code(accessor)
    if accessor.get("bufferView") is None:
        values = np.zeros((count, n_components), code)
    else:
        values = _read_view(file, accessor, code, (count, n_components))
    if "sparse" in accessor:
        values = _apply_sparse(file, get_object(accessor, "sparse"), values)
    if accessor.get("normalized") is True and values.dtype.kind in "iu":
        return np.maximum(values.astype(np.float64) / np.iinfo(values.dtype).max, -1.0)
    return values


def _code(entry: dict[str, Any]) -> str:
    code = _COMPONENTS.get(get_count(entry, "componentType"))
    if code is None:
        raise ReadError(f"glTF knows no component type {entry.get('componentType')}")
    return code


def _read_view(file: GltfFile, entry: dict[str, Any], code: str, shape: tuple[int, int]) -> NDArray[Any]:
    """Read an array out of the buffer view that an accessor, or a part of a sparse one, names."""
    view = get_entry(file.document, "bufferViews", entry.get("bufferView"))
    if any("meshopt" in name for name in get_object(view, "extensions")):
        raise FormatError("glTF compressed by meshopt is not read: send it uncompressed")
    number = get_count(view, "buffer")
    if number >= len(file.buffers):
        raise ReadError(f"a glTF buffer view names buffer {number}; there are {len(file.buffers)}")
    data = file.buffers[number]
    item = np.dtype(code).itemsize
    row = item * shape[1]
    stride = get_count(view, "byteStride", 0) or row
    start = get_count(view, "byteOffset", 0) + get_count(entry, "byteOffset", 0)
    stop = get_count(view, "byteOffset", 0) + get_count(view, "byteLength")
    needed = start + (shape[0] - 1) * stride + row if shape[0] else start
    if stride < row or needed > min(stop, len(data)):
        raise ReadError(
            f"a glTF array of {shape[0]:,} rows needs {needed:,} bytes; its buffer view ends at {stop:,} and its "
            f"buffer at {len(data):,}"
        )
    if shape[0] == 0:
        return np.zeros(shape, code)
    return np.ndarray(shape, code, data, start, (stride, item))


def _apply_sparse(file: GltfFile, sparse: dict[str, Any], values: NDArray[Any]) -> NDArray[Any]:
    count = get_count(sparse, "count")
    indices = get_object(sparse, "indices")
    places = _read_view(file, indices, _code(indices), (count, 1))[:, 0]
    if places.dtype.kind == "f" or (places >= len(values)).any():
        raise ReadError("a sparse glTF accessor replaces rows that are not there")
    result = values.copy()
    result[places] = _read_view(file, get_object(sparse, "values"), values.dtype.str, (count, values.shape[1]))
    return result
