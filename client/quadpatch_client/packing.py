"""A glTF file and the files that it names, as one file: the service gets no others.

Only files in the folder of the glTF file and below it are taken up. A name that leads elsewhere is refused: the file
may be untrusted, and the files that it names are sent to the service.

Tested in `tests/attacks/test_j_client.py`.
"""

import base64
import json
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from quadpatch_client.errors import UsageError

_MEDIA_TYPES = {".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg"}


@contextmanager
def packed(path: Path) -> Iterator[Path]:
    """Yield a mesh file that needs no other: the file itself, or a glTF file with its buffers and images inside.

    Raises
    ------
    UsageError
        If a glTF file names a file that is not there, or lies outside of its folder.
    """
    document = _gltf_with_files(path)
    if document is None:
        yield path
        return
    for entry in _outer(document):
        entry["uri"] = _data_uri(path, entry["uri"])
    with tempfile.TemporaryDirectory() as folder:
        whole = Path(folder) / path.name
        whole.write_text(json.dumps(document, separators=(",", ":")), "utf-8")
        yield whole


def _gltf_with_files(path: Path) -> dict[str, Any] | None:
    """Return the document of a glTF file that names others; what is none is left for the service to judge."""
    if path.suffix.lower() != ".gltf":
        return None
    try:
        document = json.loads(path.read_bytes())
    except (ValueError, RecursionError):
        return None
    return document if isinstance(document, dict) and _outer(document) else None


def _outer(document: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the buffers and images that lie in files of their own."""
    lists = [document.get(name) for name in ("buffers", "images")]
    entries = [entry for entries in lists if isinstance(entries, list) for entry in entries]
    return [e for e in entries if isinstance(e, dict) and isinstance(e.get("uri"), str) and _is_file(e["uri"])]


def _is_file(uri: str) -> bool:
    return not uri.startswith("data:")


def _data_uri(path: Path, uri: str) -> str:
    folder = path.parent.resolve()
    shown = ascii(uri[:80])
    try:
        target = (folder / unquote(uri)).resolve()
        is_inside = not urlsplit(uri).scheme and target.is_relative_to(folder) and target.is_file()
    except (ValueError, OSError):
        is_inside = False
    if not is_inside:
        raise UsageError(f"{path} names the file {shown}, which is not there or not in the same folder")
    media_type = _MEDIA_TYPES.get(target.suffix.lower(), "application/octet-stream")
    return f"data:{media_type};base64," + base64.b64encode(target.read_bytes()).decode("ascii")
