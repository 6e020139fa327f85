"""As which format an upload is to be read, from what the sender says. A worker reads the bytes."""

import re
from collections.abc import Mapping
from pathlib import PurePosixPath
from typing import get_args

from quadpatch_client.schema import Format

_BY_MEDIA_TYPE: Mapping[str, Format] = {
    "model/stl": "stl",
    "application/sla": "stl",
    "application/vnd.ms-pki.stl": "stl",
    "model/obj": "obj",
    "model/ply": "ply",
    "model/gltf-binary": "glb",
    "model/gltf+json": "gltf",
    "model/3mf": "3mf",
}
MAX_FILENAME = 255


def stated_format(given: Format | None, filename: str | None, media_type: str) -> Format | None:
    """Return the stated format, that of the file's name, or that of its media type; None where none is known."""
    if given is not None:
        return given
    suffix = PurePosixPath(filename or "").suffix.removeprefix(".").lower()
    by_name = next((known for known in get_args(Format) if known == suffix), None)
    return by_name or _BY_MEDIA_TYPE.get(media_type)


def clean_filename(filename: str | None) -> str | None:
    """Return the printable characters in the last step of a sender's path, None where there are none."""
    last = re.split(r"[/\\]", filename or "")[-1]
    name = "".join(character for character in last if character.isprintable()).strip()
    return name[-MAX_FILENAME:] or None
