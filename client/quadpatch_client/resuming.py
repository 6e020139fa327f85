"""Uploads that go on where the line broke, by the protocol tus 1.0 (https://tus.io/protocols/resumable-upload)."""

import base64
import hashlib
import uuid
from pathlib import Path

import httpx

from quadpatch_client.errors import DamagedTransferError, RefusedError, WaitTimeoutError
from quadpatch_client.patience import TryAgainError
from quadpatch_client.progress import ByteProgress
from quadpatch_client.transfers import file_chunks
from quadpatch_client.transport import Transport

# From this size on an upload is made resumable; a smaller one is sent again as a whole.
RESUMABLE_BYTES = 32 << 20
_TUS = {"Tus-Resumable": "1.0.0"}
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
        url = _start(transport, path, name, sha256)
        return _Sender(transport, path, url, progress).send()
    except RefusedError as error:
        if error.problem.code == "digest_mismatch":
            raise DamagedTransferError(f"{path.name} arrived damaged: its sha256 is not {sha256}") from error
        if error.problem.code == "route_not_found":
            return None
        raise


def _start(transport: Transport, path: Path, name: str, sha256: str) -> str:
    values = {"filename": name, "sha256": sha256}
    pairs = (f"{key} {base64.b64encode(value.encode()).decode()}" for key, value in values.items())
    headers = {**_TUS, "Upload-Length": str(path.stat().st_size), "Upload-Metadata": ",".join(pairs)}
    own_key = f"upload-{sha256}-{hashlib.sha256(name.encode()).hexdigest()[:16]}"
    try:
        answer = transport.request("POST", "/v1/uploads", headers={**headers, "Idempotency-Key": own_key})
    except RefusedError as error:
        # What was begun under that key has expired, or failed.
        if error.problem.status not in (httpx.codes.NOT_FOUND, httpx.codes.GONE) or error.problem.code[:6] == "route_":
            raise
        answer = transport.request("POST", "/v1/uploads", headers={**headers, "Idempotency-Key": str(uuid.uuid4())})
    return str(answer.headers["Location"])


class _Sender:
    """Sends what the service does not have yet, until it has everything."""

    def __init__(self, transport: Transport, path: Path, url: str, progress: ByteProgress) -> None:
        self._transport, self._path, self._url, self._progress = transport, path, url, progress
        self._size = path.stat().st_size
        self._offset = 0
        self._n_waits = 0

    def send(self) -> str:
        """Return the id of the mesh."""
        # The service may take its time to put the bytes together: to wait for that is no failure.
        return self._transport.patiently(self._attempt, lambda: self._offset + self._n_waits)

    def _attempt(self) -> str:
        answer = self._transport.send("HEAD", self._url, headers=_TUS)
        self._offset = int(answer.headers["Upload-Offset"])
        if self._offset < self._size:
            answer = self._send_rest()
            self._offset = self._size
        mesh = answer.headers.get("Quadpatch-Mesh")
        if mesh is None:
            self._n_waits += 1
            raise TryAgainError(WaitTimeoutError(f"{self._path.name} has arrived, and is no mesh yet"), _PAUSE_S)
        self._progress(self._size, self._size)
        return str(mesh).rpartition("/")[2]

    def _send_rest(self) -> httpx.Response:
        headers = {
            **_TUS,
            "Content-Type": "application/offset+octet-stream",
            "Content-Length": str(self._size - self._offset),
            "Upload-Offset": str(self._offset),
        }
        try:
            content = file_chunks(self._path, self._progress, self._offset)
            return self._transport.send("PATCH", self._url, headers=headers, content=content)
        except RefusedError as error:
            # The request that was broken off has stored more meanwhile.
            if error.problem.code != "upload_offset_conflict":
                raise
            raise TryAgainError(error, None) from error
