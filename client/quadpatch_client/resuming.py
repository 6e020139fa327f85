"""Uploads that go on where the line broke, by the protocol tus 1.0 (https://tus.io/protocols/resumable-upload)."""

import base64
import hashlib
import uuid
from collections.abc import Mapping
from pathlib import Path

import httpx

from quadpatch_client.errors import DamagedTransferError, RefusedError, WaitTimeoutError
from quadpatch_client.patience import TryAgainError
from quadpatch_client.progress import ByteProgress
from quadpatch_client.transfers import file_chunks
from quadpatch_client.transport import Transport

# From this size on an upload is made resumable; a smaller one is sent again as a whole.
RESUMABLE_BYTES = 32 << 20
TUS = {"Tus-Resumable": "1.0.0"}
_PAUSE_S = 1.0


def upload_resumably(transport: Transport, path: Path, name: str, sha256: str, progress: ByteProgress) -> str | None:
    """Send a file, and return the id of the mesh that it became; None where the service knows no such uploads.

    A program that was ended goes on where it was when it sends the same file again within a day.

    Parameters
    ----------
    transport : Transport
    path : Path
    name : str
        Of the file, for the service.
    sha256 : str
        Of its bytes, in hex.
    progress : callable

    Raises
    ------
    DamagedTransferError
        If the service received other bytes.
    """
    try:
        size, metadata = path.stat().st_size, {"filename": name, "sha256": sha256}
        url = start(transport, f"upload-{key_of(name, sha256)}", size, metadata)
        return Sender(transport, path, url, 0, size, progress).send_mesh()
    except RefusedError as error:
        if error.problem.code == "digest_mismatch":
            raise DamagedTransferError(f"{path.name} arrived damaged: its sha256 is not {sha256}") from error
        if error.problem.code == "route_not_found":
            return None
        raise


def key_of(name: str, sha256: str) -> str:
    """Return a text that is the same for the same bytes under the same name."""
    return f"{sha256}-{hashlib.sha256(name.encode()).hexdigest()[:16]}"


def start(
    transport: Transport, key: str, size: int | None, metadata: Mapping[str, str], concat: str | None = None
) -> str:
    """Begin an upload, or take one up that was begun before under the same key; return its address.

    Parameters
    ----------
    transport : Transport
    key : str
        The same for the same bytes.
    size : int, optional
        In bytes; None where others are joined.
    metadata : mapping
        For the service.
    concat : str, optional
        `partial`, or `final;` and the addresses of what is joined.
    """
    pairs = (f"{name} {base64.b64encode(value.encode()).decode()}" for name, value in metadata.items())
    headers = {**TUS, "Upload-Metadata": ",".join(pairs)} if metadata else dict(TUS)
    headers |= {} if size is None else {"Upload-Length": str(size)}
    headers |= {} if concat is None else {"Upload-Concat": concat}
    try:
        answer = transport.request("POST", "/v1/uploads", headers={**headers, "Idempotency-Key": key})
    except RefusedError as error:
        # What was begun under that key has expired, or failed.
        if error.problem.status not in (httpx.codes.NOT_FOUND, httpx.codes.GONE) or error.problem.code[:6] == "route_":
            raise
        answer = transport.request("POST", "/v1/uploads", headers={**headers, "Idempotency-Key": str(uuid.uuid4())})
    return str(answer.headers["Location"])


class Sender:
    """Sends what the service does not have yet of a part of a file, until it has everything.

    Parameters
    ----------
    transport : Transport
    path : Path
    url : str
        Of the upload.
    begin, end : int
        Where the part lies in the file, in bytes.
    progress : callable
        Gets the place in the file.
    """

    def __init__(
        self, transport: Transport, path: Path, url: str, begin: int, end: int, progress: ByteProgress
    ) -> None:
        self._transport, self._path, self._url, self._progress = transport, path, url, progress
        self._begin, self._end = begin, end
        self._offset = 0
        self._n_waits = 0

    def send(self) -> httpx.Response:
        """Send the bytes, and return the last answer."""
        return self._transport.patiently(self._attempt, lambda: self._offset)

    def send_mesh(self) -> str:
        """Send the bytes, and return the id of the mesh that they became."""
        # The service may take its time to put the bytes together: to wait for that is no failure.
        return self._transport.patiently(self._attempt_mesh, lambda: self._offset + self._n_waits)

    def _attempt_mesh(self) -> str:
        mesh = self._attempt().headers.get("Quadpatch-Mesh")
        if mesh is None:
            self._n_waits += 1
            raise TryAgainError(WaitTimeoutError(f"{self._path.name} has arrived, and is no mesh yet"), _PAUSE_S)
        self._progress(self._end, self._end)
        return str(mesh).rpartition("/")[2]

    def _attempt(self) -> httpx.Response:
        answer = self._transport.send("HEAD", self._url, headers=TUS)
        self._offset = int(answer.headers["Upload-Offset"])
        if self._offset < self._end - self._begin:
            answer = self._send_rest()
            self._offset = self._end - self._begin
        return answer

    def _send_rest(self) -> httpx.Response:
        first = self._begin + self._offset
        headers = {
            **TUS,
            "Content-Type": "application/offset+octet-stream",
            "Content-Length": str(self._end - first),
            "Upload-Offset": str(self._offset),
        }
        try:
            content = file_chunks(self._path, self._progress, first, self._end)
            return self._transport.send("PATCH", self._url, headers=headers, content=content)
        except RefusedError as error:
            # The request that was broken off has stored more meanwhile.
            if error.problem.code != "upload_offset_conflict":
                raise
            raise TryAgainError(error, None) from error
