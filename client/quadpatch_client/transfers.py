"""Transfers of files: counted, hashed, resumed, and visible under their name only when they are complete."""

import hashlib
import os
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path

import httpx

from quadpatch_client.errors import DamagedTransferError
from quadpatch_client.outputs import current_umask, deliver, folder_of
from quadpatch_client.progress import ByteProgress
from quadpatch_client.transport import Transport

CHUNK_BYTES = 1 << 18
_CONTROL = re.compile(r"[\x00-\x1f\x7f]")
_LONGEST_NAME = 255
_LONGEST_LABEL = 200


def sha256_of(path: Path) -> str:
    """Return the sha256 of a file, in hex."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def sent_name(path: Path) -> str:
    """Return the name of a file as it is sent: without control characters, `?` for bytes that are no text."""
    return _CONTROL.sub("", path.name).encode("utf-8", "replace").decode("utf-8")[-_LONGEST_NAME:]


def label_of(path: Path) -> str | None:
    """Return what a job on a file is called where nothing else is said: its name, without its beginning if too long."""
    return sent_name(path)[-_LONGEST_LABEL:] or None


def file_chunks(path: Path, progress: ByteProgress, start: int = 0, end: int | None = None) -> Iterator[bytes]:
    """Yield the bytes of a file from `start` on, up to its end or to `end`, telling how far it is."""
    total, done = path.stat().st_size, start
    last = total if end is None else end
    with path.open("rb") as file:
        file.seek(start)
        while chunk := file.read(min(CHUNK_BYTES, last - done)):
            yield chunk
            done += len(chunk)
            progress(done, total)


def download(transport: Transport, path: str, target: Path, sha256: str, progress: ByteProgress) -> None:
    """Fetch a file; a broken line is taken up where it broke.

    Parameters
    ----------
    transport : Transport
    path : str
        On the service.
    target : Path
        Appears whole, in one step, or not at all; see `quadpatch_client.outputs` for links and streams.
    sha256 : str
        What the bytes have to hash to, in hex.
    progress : callable

    Raises
    ------
    DamagedTransferError
        If other bytes arrived.
    """
    descriptor, name = tempfile.mkstemp(dir=folder_of(target), prefix=f".{target.name}.", suffix=".part")
    os.close(descriptor)
    partial = Path(name)
    try:
        transport.patiently(lambda: _fetch_rest(transport, path, partial, progress), lambda: partial.stat().st_size)
        if sha256_of(partial) != sha256:
            raise DamagedTransferError(f"{path} arrived damaged: its sha256 is not {sha256}")
        partial.chmod(0o666 & ~current_umask())
        deliver(partial, target)
    finally:
        partial.unlink(missing_ok=True)


def _fetch_rest(transport: Transport, path: str, partial: Path, progress: ByteProgress) -> None:
    start = partial.stat().st_size
    # Compressed on the way, the bytes could neither be counted nor taken up in the middle.
    headers = {"Accept-Encoding": "identity"} | ({"Range": f"bytes={start}-"} if start else {})
    with transport.stream(path, headers) as response:
        # A service that does not know ranges, or whose file has changed, sends everything again.
        resumes = response.status_code == httpx.codes.PARTIAL_CONTENT
        done = start if resumes else 0
        total = done + int(response.headers.get("Content-Length", 0))
        with partial.open("ab" if resumes else "wb") as file:
            for chunk in response.iter_raw():
                file.write(chunk)
                done += len(chunk)
                progress(done, max(done, total))
