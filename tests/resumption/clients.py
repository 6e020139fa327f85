"""Clients that send a file by the protocol tus: two peers, and the SDK of this project."""

import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from urllib.parse import urljoin

import httpx
from tusclient.client import TusClient
from tusclient.exceptions import TusCommunicationError, TusUploadFailed

from quadpatch_client.sdk import Client
from tests.waiting import GUARD_S, wait_until

TUS = MappingProxyType({"Tus-Resumable": "1.0.0"})
# tuspy tries again by recursion, so not too often.
_PAUSE_S = 1.0
_TRIES = 2000
_SCRIPT = Path(__file__).with_name("tus_js_client.cjs")


def send_by_tuspy(url: str, path: Path, chunk_bytes: int, has_checksums: bool = False) -> str:
    """Send a file by tuspy; return the URL of the upload."""

    def created() -> str | None:
        # It repeats what continues an upload, but not what makes one.
        try:
            return str(uploader.create_url())
        except (TusCommunicationError, TusUploadFailed):
            return None

    with path.open("rb") as file:
        uploader = TusClient(f"{url}/v1/uploads").uploader(
            file_stream=file,
            chunk_size=chunk_bytes,
            metadata={"filename": path.name},
            retries=_TRIES,
            retry_delay=_PAUSE_S,
            upload_checksum=has_checksums,
        )
        uploader.set_url(wait_until(created))
        uploader.upload()
        return str(uploader.url)


def send_by_tus_js(url: str, path: Path, chunk_bytes: int, modules: Path, parallel: int = 1) -> str:
    """Send a file by tus-js-client, which npm has installed into a folder `node_modules`; return the upload's URL."""
    words = ["node", str(_SCRIPT), f"{url}/v1/uploads", str(path), str(chunk_bytes), str(parallel)]
    environment = {"NODE_PATH": str(modules), "PATH": "/usr/local/bin:/usr/bin:/bin"}
    sent = subprocess.run(words, env=environment, check=True, capture_output=True, text=True)
    return sent.stdout.strip()


def mesh_of(url: str, upload: str) -> str:
    """Return the id of the mesh that an upload became."""

    def answered() -> Mapping[str, str] | None:
        try:
            answer = httpx.head(urljoin(url, upload), headers=TUS, timeout=GUARD_S)
        except httpx.TransportError:
            return None
        return answer.headers if answer.is_success and "quadpatch-mesh" in answer.headers else None

    return wait_until(answered)["quadpatch-mesh"].rpartition("/")[2]


def send_by_sdk(url: str, path: Path) -> str:
    """Send a file by the SDK; return the id of the mesh."""
    with Client(url, patience_s=GUARD_S) as client:
        return client.upload(path).id


Sender = Callable[[str, Path], str]
