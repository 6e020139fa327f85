"""Checks of bytes against the sha256 that names them, and that sha256 as HTTP writes it (RFC 9530).

Tested in `tests/attacks/test_e_stored.py`.
"""

import base64
import hashlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from jobkit.errors import ObjectDamagedError
from jobkit.storage.base import CHUNK_BYTES, ObjectStore
from jobkit.storage.spool import translated_os_errors


def sha256_of(path: Path) -> str:
    """Return the sha256 of a file, as 64 hexadecimal digits."""
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while chunk := file.read(CHUNK_BYTES):
            digest.update(chunk)
    return digest.hexdigest()


@contextmanager
def verified_file(store: ObjectStore, key: str, sha256: str) -> Iterator[Path]:
    """Give an object as a file, once its bytes are known to be those that were stored.

    Raises
    ------
    ObjectDamagedError
        If they are others.
    """
    with store.local_file(key) as path:
        with translated_os_errors():
            actual_sha256 = sha256_of(path)
        if actual_sha256 != sha256:
            raise ObjectDamagedError(f"the bytes under {key!r} are not those that were stored")
        yield path


def verified_chunks(chunks: Iterable[bytes], sha256: str) -> Iterator[bytes]:
    """Yield the chunks; the last one only if all of them have that sha256, so that damage is never received whole.

    Raises
    ------
    ObjectDamagedError
        In place of the last chunk.
    """
    digest, pending_chunk = hashlib.sha256(), b""
    for chunk in chunks:
        digest.update(chunk)
        if pending_chunk:
            yield pending_chunk
        pending_chunk = chunk
    if digest.hexdigest() != sha256:
        raise ObjectDamagedError(f"the bytes of {sha256} in the store are not those that were stored")
    yield pending_chunk


def digest_field(sha256: str) -> str:
    """Return the value of `Repr-Digest` for 64 hexadecimal digits."""
    return f"sha-256=:{base64.b64encode(bytes.fromhex(sha256)).decode('ascii')}:"
