"""Calls of the client that are about meshes: send a file, see what the analysis says.

Tested in `tests/quadpatch_client/test_resuming.py`.
"""

from pathlib import Path

import httpx

from quadpatch_client.errors import DamagedTransferError, MeshRejectedError, RefusedError, WaitTimeoutError
from quadpatch_client.packing import packed
from quadpatch_client.parallel_upload import PARALLEL_BYTES, upload_in_parts
from quadpatch_client.polling import parse, poll
from quadpatch_client.progress import ByteProgress, no_progress
from quadpatch_client.resuming import RESUMABLE_BYTES, upload_resumably
from quadpatch_client.schema import Mesh, MeshState
from quadpatch_client.transfers import file_chunks, sent_name, sha256_of
from quadpatch_client.transport import Transport


class MeshCalls:
    """Calls about meshes.

    Parameters
    ----------
    transport : Transport
    """

    def __init__(self, transport: Transport) -> None:
        self._transport = transport
        # Of the meshes that were uploaded here, by id: the service may know the same bytes under another name.
        self._names: dict[str, str] = {}

    def upload(self, path: Path, progress: ByteProgress = no_progress) -> Mesh:
        """Send a mesh file; bytes that the service has already are not sent again.

        From 32 MiB on, an upload goes on where the line broke.

        A glTF file is sent with the files that it names inside.

        Raises
        ------
        UsageError
            If a glTF file names a file that is not there, or lies outside of its folder.
        DamagedTransferError
            If the service received other bytes.
        """
        with packed(path) as whole:
            return self._upload(whole, progress)

    def mesh(self, mesh_id: str) -> Mesh:
        """Return a mesh as it stands."""
        return parse(Mesh, self._transport.request("GET", f"/v1/meshes/{mesh_id}"))

    def wait_for_mesh(self, mesh_id: str, timeout_s: float | None = None) -> Mesh:
        """Wait until a mesh is analysed.

        Raises
        ------
        MeshRejectedError
            If the service could not read it.
        WaitTimeoutError
        """
        for mesh in poll(self._transport, f"/v1/meshes/{mesh_id}", Mesh, timeout_s):
            if mesh.state == MeshState.REJECTED and mesh.problem is not None:
                raise MeshRejectedError(mesh.problem)
            if mesh.state == MeshState.READY:
                return mesh
        raise WaitTimeoutError(f"mesh {mesh_id} was not analysed within {timeout_s:g} s")

    def _upload(self, path: Path, progress: ByteProgress) -> Mesh:
        sha256 = sha256_of(path)
        self._names[sha256] = sent_name(path)
        known = self._find_mesh(sha256)
        if known is not None and known.state != MeshState.REJECTED:
            size = path.stat().st_size
            progress(size, size)
            return known
        mesh = self._send(path, sha256, progress)
        if mesh.id != sha256:
            raise DamagedTransferError(f"{path.name} arrived damaged: the service got {mesh.id}, sent was {sha256}")
        return mesh

    def _send(self, path: Path, sha256: str, progress: ByteProgress) -> Mesh:
        size, name = path.stat().st_size, sent_name(path)
        if size >= RESUMABLE_BYTES:
            upload = upload_in_parts if size >= PARALLEL_BYTES else upload_resumably
            mesh_id = upload(self._transport, path, name, sha256, progress)
            if mesh_id is not None:
                return self.mesh(mesh_id)
        response = self._transport.request(
            "POST",
            "/v1/meshes",
            params={"filename": name},
            headers={"Content-Type": "application/octet-stream", "Content-Length": str(size)},
            content=lambda: file_chunks(path, progress),
        )
        return parse(Mesh, response)

    def _find_mesh(self, mesh_id: str) -> Mesh | None:
        try:
            return self.mesh(mesh_id)
        except RefusedError as error:
            if error.problem.status != httpx.codes.NOT_FOUND:
                raise
            return None
