"""Opens the store that a URL names."""

import re
import tempfile
from pathlib import Path
from urllib.parse import unquote, urlsplit

from jobkit.errors import SettingsError
from jobkit.storage.base import ObjectStore
from jobkit.storage.local import LocalStore

_BUCKET = re.compile(r"^[a-z0-9][a-z0-9._-]{1,62}\Z")


def open_store(url: str, scratch: Path | None = None) -> ObjectStore:
    """Open the store that the URL names: `file:///a/folder` or `s3://bucket/prefix`.

    Parameters
    ----------
    url : str
    scratch : Path, optional
        Folder on a local disk for what comes from a remote store or goes there; None: one for temporary files.

    Raises
    ------
    SettingsError
        If the URL names another kind of store.
    """
    parts = urlsplit(url)
    if parts.scheme == "file" and parts.netloc in ("", "localhost"):
        return LocalStore(Path(unquote(parts.path)))
    if parts.scheme == "s3" and _BUCKET.match(parts.netloc) and not parts.query:
        # A process with local files needs no S3 client in memory.
        from jobkit.storage.s3 import S3Store  # noqa: PLC0415

        return S3Store(parts.netloc, parts.path.strip("/"), scratch or Path(tempfile.gettempdir(), "quadpatch-scratch"))
    # Without the URL: it may hold a password.
    raise SettingsError("that object store is not supported; use file:///a/folder or s3://bucket/prefix")
