"""Telling the format of a mesh file from its content, and from its suffix where the content leaves it open."""

import re

from quadpatch.errors import EncodedMeshError, FormatError, ReadError
from quadpatch.formats.stl_layout import is_binary_stl, is_binary_stl_with_more
from quadpatch.formats.text import decode_text

KNOWN = ("ply", "stl", "obj", "off", "glb", "gltf", "3mf")

_OFF = re.compile(rb"(ST)?C?N?4?n?OFF(?![^\s])")
_OBJ_LINE = re.compile(rb"^[ \t]*(v|vt|vn|f|mtllib)[ \t]+[^\s]", re.MULTILINE)
_LOOK_AT = 1 << 16
# How an encoded mesh begins.
QPZ_MAGIC = b"QPZ\x1a"


def detect_format(data: bytes, suffix: str) -> str:
    """Tell the format of a file.

    Parameters
    ----------
    data : bytes
        The whole file.
    suffix : str
        Of its name, lower case, without the dot; may be empty.

    Returns
    -------
    str
        One of `KNOWN`.

    Raises
    ------
    ReadError
        If the file is empty.
    FormatError
        If it is in no known format; EncodedMeshError if it is a `.qpz` file.
    """
    if re.search(rb"[^\0\s]", data) is None:
        raise ReadError("the file is empty")
    found = _by_magic(data) or _by_text(decode_text(data[:_LOOK_AT])[0] if data[:1] != b"\0" else b"")
    if found is None and suffix in KNOWN:
        found = suffix
    if found is None and is_binary_stl_with_more(data):
        found = "stl"
    if found is None:
        raise FormatError(f"this is none of the formats that are read: {', '.join(KNOWN)}")
    if found == "qpz":
        raise EncodedMeshError("this is a .qpz file: decode it first")
    if found in _UNREAD:
        raise FormatError(_UNREAD[found])
    return found


_UNREAD = {
    "zip": "a zip archive that is no 3MF package is not read: unpack it and send the mesh",
    "dae": "COLLADA is not read: convert it to glTF",
    "fbx": "FBX is not read: convert it to glTF",
    "vtk": "VTK files are not read: convert them to PLY",
}


def _by_magic(data: bytes) -> str | None:
    if re.match(rb"ply[ \t]*[\r\n]", data):
        return "ply"
    if data[:4] == b"glTF":
        return "glb"
    if data[:4] == QPZ_MAGIC:
        return "qpz"
    if data[:4] == b"PK\x03\x04":
        # The names of the entries stand uncompressed in the archive's directory at its end.
        return "3mf" if b".model" in data[-_LOOK_AT:] or b".model" in data[:_LOOK_AT] else "zip"
    if is_binary_stl(data):
        return "stl"
    return "fbx" if data.startswith(b"Kaydara FBX Binary") else None


def _by_text(text: bytes) -> str | None:
    start = text.lstrip()
    if start[:1] == b"{" and b'"asset"' in text:
        return "gltf"
    if start[:1] == b"<" and b"<COLLADA" in text:
        return "dae"
    if start.startswith(b"# vtk DataFile"):
        return "vtk"
    if start[:5].lower() == b"solid" and re.search(rb"facet|endsolid", text, re.IGNORECASE):
        return "stl"
    without_comments = re.sub(rb"^\s*(#[^\r\n]*\s*)*", b"", text)
    if _OFF.match(without_comments):
        return "off"
    return "obj" if _OBJ_LINE.search(text) and b"\0" not in text else None
