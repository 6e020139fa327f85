"""Uploads of large files in several parts at once: over a long line one connection alone does not fill it.

Each part is an upload of its own that goes on where the line broke; a last one joins them (the extension
`concatenation` of tus 1.0).

Tested in `tests/integration/test_resumable_uploads.py`.
"""

import threading
from functools import partial
from pathlib import Path

from quadpatch_client.errors import RefusedError
from quadpatch_client.progress import ByteProgress
from quadpatch_client.resuming import Sender, key_of, start, upload_resumably
from quadpatch_client.transport import Transport
from quadpatch_client.workers import Workers

# From this size on a file is sent in parts.
PARALLEL_BYTES = 128 << 20
_N_PARTS = 4
# A part has expired, or was joined by another client meanwhile; or the service joins none.
_NO_JOINING = frozenset({"upload_not_found", "upload_not_finished", "malformed_header"})


def upload_in_parts(transport: Transport, path: Path, name: str, sha256: str, progress: ByteProgress) -> str | None:
    """Send a file, as `upload_resumably` does, by four connections at once."""
    size = path.stat().st_size
    bounds = [size * i // _N_PARTS for i in range(_N_PARTS + 1)]
    places, lock = bounds[:-1], threading.Lock()

    def note(part: int, place: int, _: int) -> None:
        with lock:
            places[part] = place
            progress(sum(places) - sum(bounds[:-1]), size)

    def send(part: int) -> str:
        begin, end = bounds[part], bounds[part + 1]
        url = start(transport, f"part-{part}-of-{_N_PARTS}-{sha256}", end - begin, {}, "partial")
        Sender(transport, path, url, begin, end, partial(note, part)).send()
        return url

    workers = Workers(_N_PARTS)
    try:
        sent = [workers.submit(partial(send, part)) for part in range(_N_PARTS)]
        joined = "final;" + " ".join(future.result() for future in sent)
        metadata = {"filename": name, "sha256": sha256}
        url = start(transport, f"joined-{key_of(name, sha256)}", None, metadata, joined)
        return Sender(transport, path, url, 0, size, progress).send_mesh()
    except RefusedError as error:
        if error.problem.code not in _NO_JOINING:
            raise
        return upload_resumably(transport, path, name, sha256, progress)
    finally:
        workers.close()
