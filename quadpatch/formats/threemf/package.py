"""3MF packages: zip archives whose parts are unpacked within limits.

The sizes that an archive's directory declares bound what is unpacked, so they are added up and held against the limit
before anything is; the reader then stops at the declared size and checks the sum over the content.

Tested in `tests/quadpatch/formats/threemf/test_reader.py`.
"""

import io
import re
import struct
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from quadpatch.errors import ReadError
from quadpatch.formats.limits import ReadLimits

_RELATION = re.compile(rb"<(?:[\w.-]+:)?Relationship\b[^>]*>")
_MODEL_TYPE = b"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
_MOST_ENTRIES = 100_000
# Entries that are added have a fixed time, so that equal meshes are equal bytes.
_TIME = (1980, 1, 1, 0, 0, 0)
_UNREADABLE = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    EOFError,
    NotImplementedError,  # a compression method that is unknown
    RuntimeError,  # an entry that is encrypted
    OSError,
    ValueError,
    IndexError,
    KeyError,
)


@dataclass(frozen=True)
class Package:
    """An archive in memory."""

    data: bytes
    names: tuple[str, ...]
    root: str

    def read(self, name: str) -> bytes:
        """Unpack one entry.

        Raises
        ------
        ReadError
            If it is not there, or broken.
        """
        if name not in self.names:
            raise ReadError(f"the 3MF package has no part {name[:80]!r}")
        with _archive(self.data) as archive:
            return archive.read(name)

    def with_changed(self, changed: dict[str, bytes]) -> bytes:
        """Pack again with some entries replaced or added; all others keep their content, names, order and times."""
        packed = io.BytesIO()
        with _archive(self.data) as archive, zipfile.ZipFile(packed, "w") as target:
            for info in archive.infolist():
                entry = zipfile.ZipInfo(info.filename, info.date_time)
                stored = info.compress_type == zipfile.ZIP_STORED
                entry.compress_type = zipfile.ZIP_STORED if stored else zipfile.ZIP_DEFLATED
                entry.external_attr, entry.create_system = info.external_attr, info.create_system
                target.writestr(entry, changed.get(info.filename) or archive.read(info))
            for name in [name for name in changed if name not in self.names]:
                entry = zipfile.ZipInfo(name, _TIME)
                entry.compress_type = zipfile.ZIP_DEFLATED
                target.writestr(entry, changed[name])
        return packed.getvalue()


@contextmanager
def _archive(data: bytes) -> Iterator[zipfile.ZipFile]:
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            yield archive
    except _UNREADABLE as error:
        raise ReadError(f"the 3MF package is broken: {str(error)[:120]}") from error


def open_package(data: bytes, limits: ReadLimits) -> Package:
    """Open a package and find its root model.

    Parameters
    ----------
    data : bytes
        The whole file.
    limits : ReadLimits

    Raises
    ------
    ReadError, TooLargeError
    """
    with _archive(data) as archive:
        infos = archive.infolist()
    names = tuple(info.filename for info in infos)
    if len(set(names)) < len(names) or len(names) > _MOST_ENTRIES:
        raise ReadError(f"the 3MF package has {len(names):,} entries, {len(set(names)):,} of them with different names")
    limits.check_bytes(sum(info.file_size for info in infos))
    with _archive(data) as archive:
        # Every entry has to be packed again at the end: a broken one is better named now.
        broken = archive.testzip()
    if broken is not None:
        raise ReadError(f"the entry {broken[:80]!r} of the 3MF package is broken")
    package = Package(data, names, "")
    return Package(data, names, _find_root(package))


def _find_root(package: Package) -> str:
    if "_rels/.rels" in package.names:
        for relation in _RELATION.findall(package.read("_rels/.rels")):
            target = re.search(rb"""Target\s*=\s*["']/?([^"']+)["']""", relation)
            if _MODEL_TYPE in relation and target is not None:
                return target.group(1).decode("utf-8", "replace")
    models = [name for name in package.names if name.lower().endswith(".model")]
    if not models:
        raise ReadError("the 3MF package has no model")
    return min(models, key=len)
