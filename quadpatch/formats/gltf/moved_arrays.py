"""Arrays of a glTF document whose rows change.

An accessor may be named by several primitives, and a mesh be placed by several nodes. As long as all of them ask for
the same rows, or for different ones, the accessor's own bytes are written over. Where two ask for another value of one
row, the later one gets a copy. Accessors that are not plain float32, as of quantised or sparse arrays, get a float32
copy as well.

Tested in `tests/quadpatch/formats/test_moving.py`.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadpatch.formats.gltf.accessors import get_count, get_entry
from quadpatch.formats.gltf.container import GltfFile
from quadpatch.formats.gltf.primitive import Store
from quadpatch.types import BoolArray, FloatArray

_FLOAT = 5126
# Copies that a claim is compared with: a mesh that is placed thousands of times costs its own size each time, no more.
_MOST_COMPARED = 16

# Share of the largest number by which two that went through different transforms may differ: some steps of float32.
_SAME = 4 * float(np.finfo(np.float32).eps)

Single = NDArray[np.float32]
# An accessor and which of its copies, 0 for itself.
Key = tuple[int, int]


@dataclass
class _Held:
    """Rows of one accessor or copy: values, and which of them are asked for."""

    values: Single
    is_claimed: BoolArray


@dataclass
class MovedArrays:
    """What is asked of the accessors of a document, until it is written."""

    file: GltfFile
    _held: dict[int, list[_Held]] = field(default_factory=dict)
    _before: dict[int, Single] = field(default_factory=dict)

    def claim(self, accessor: int, before: FloatArray, after: FloatArray, is_used: BoolArray) -> Key:
        """Ask for rows of an accessor.

        Parameters
        ----------
        accessor : int
        before, after : (k, width) float64
            All rows as they are, and as they are to be.
        is_used : (k,) bool
            Rows whose values matter.
        """
        with np.errstate(over="ignore"):
            old, new = before.astype(np.float32), after.astype(np.float32)
        self._before.setdefault(accessor, old)
        held = self._held.setdefault(accessor, [_Held(old.copy(), np.zeros(len(old), dtype=bool))])
        for number, copy in enumerate(held[:_MOST_COMPARED]):
            both = is_used & copy.is_claimed
            if np.allclose(copy.values[both], new[both], rtol=0.0, atol=_SAME * _largest(new), equal_nan=True):
                only_now = is_used & ~copy.is_claimed
                copy.values[only_now] = new[only_now]
                copy.is_claimed |= is_used
                return accessor, number
        held.append(_Held(np.where(is_used[:, np.newaxis], new, old), is_used.copy()))
        return accessor, len(held) - 1

    def written(self) -> tuple[Store, dict[Key, int]]:
        """Write all that was asked for; returns the document, to be added to, and the accessor of each key."""
        buffers = [bytearray(buffer) for buffer in self.file.buffers]
        document = dict(self.file.document)
        document["accessors"] = list(document["accessors"])
        numbers: dict[Key, int] = {}
        for accessor, (own, *_) in self._held.items():
            changed = np.flatnonzero(_differ(own.values, self._before[accessor]))
            if len(changed) == 0 or self._is_plain(accessor):
                numbers[accessor, 0] = accessor
            if len(changed) and self._is_plain(accessor):
                self._overwrite(buffers, accessor, own.values, changed)
                document["accessors"][accessor] = _with_range(document["accessors"][accessor], own.values)
        parts = [bytes(buffer) for buffer in buffers]
        store = Store.of(GltfFile(document, parts, self.file.chunks, self.file.is_binary))
        for accessor, held in self._held.items():
            for number, copy in enumerate(held):
                if (accessor, number) not in numbers:
                    numbers[accessor, number] = store.add_array(copy.values, "f4")
        return store, numbers

    def _is_plain(self, accessor: int) -> bool:
        entry = get_entry(self.file.document, "accessors", accessor)
        return entry.get("componentType") == _FLOAT and "sparse" not in entry and entry.get("bufferView") is not None

    def _overwrite(self, buffers: list[bytearray], accessor: int, values: Single, changed: NDArray[np.int64]) -> None:
        entry = get_entry(self.file.document, "accessors", accessor)
        view = get_entry(self.file.document, "bufferViews", entry.get("bufferView"))
        row = values.shape[1] * values.itemsize
        stride = get_count(view, "byteStride", 0) or row
        start = get_count(view, "byteOffset", 0) + get_count(entry, "byteOffset", 0)
        raw = np.frombuffer(buffers[get_count(view, "buffer")], np.uint8)
        places = (start + changed * stride)[:, np.newaxis] + np.arange(row)
        raw[places] = np.ascontiguousarray(values[changed].astype("<f4")).view(np.uint8).reshape(len(changed), row)


def _largest(values: Single) -> float:
    return float(np.nanmax(np.abs(values), initial=0.0))


def _differ(one: Single, other: Single) -> BoolArray:
    """Rows (k,) that are not the same numbers; NaN is the same as NaN."""
    return np.asarray(((one != other) & ~(np.isnan(one) & np.isnan(other))).any(axis=1))


def _with_range(entry: dict[str, Any], values: Single) -> dict[str, Any]:
    """State the range anew where the entry states one."""
    if "min" not in entry and "max" not in entry:
        return entry
    finite = values[np.isfinite(values).all(axis=1)]
    if len(finite) == 0:
        return entry
    return {**entry, "min": finite.min(axis=0).tolist(), "max": finite.max(axis=0).tolist()}
