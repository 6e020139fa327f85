"""glTF 2.0 containers: the JSON document and its buffers, as `.glb` or as `.gltf`.

Nothing is fetched from the network. A buffer in a file of its own is read only from the folder of the mesh or below
it; images are looked at where a hole lies in one (`quadpatch.formats.gltf.images`).

Tested in `tests/quadpatch/formats/gltf/test_reader.py`.
"""

import base64
import binascii
import json
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NoReturn
from urllib.parse import unquote, urlsplit

from quadpatch.errors import FormatError, ReadError
from quadpatch.formats.limits import ReadLimits

_JSON, _BIN = 0x4E4F534A, 0x004E4942
# Extensions that keep the geometry where only their own decoder finds it.
_COMPRESSED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")


@dataclass(frozen=True)
class GltfFile:
    """A glTF file in memory.

    Attributes
    ----------
    document : dict
        The JSON document.
    buffers : list of bytes
    chunks : list of (int, bytes)
        Chunks of a `.glb` behind JSON and BIN, kept as they are.
    is_binary : bool
        Whether it is a `.glb`.
    data : bytes
        The file as it was read.
    folder : Path or None
        Where further files of it may lie; None allows none.
    """

    document: dict[str, Any]
    buffers: list[bytes]
    chunks: list[tuple[int, bytes]]
    is_binary: bool
    data: bytes = b""
    folder: Path | None = None

    def as_binary(self) -> "GltfFile":
        """Return the same as a `.glb`, its first buffer the binary chunk."""
        if self.is_binary:
            return self
        listed = [dict(buffer) for buffer in self.document.get("buffers", [])]
        if listed:
            listed[0].pop("uri", None)
        document = {**self.document, **({"buffers": listed} if listed else {})}
        return replace(self, document=document, is_binary=True)

    @property
    def is_whole(self) -> bool:
        """Whether no buffer lies in a file of its own."""
        listed = self.document.get("buffers", [])
        return all(str(buffer.get("uri", "data:")).startswith("data:") for buffer in listed)


def load_gltf(data: bytes, folder: Path | None, limits: ReadLimits) -> GltfFile:
    """Take a glTF file apart.

    Parameters
    ----------
    data : bytes
        The whole file.
    folder : Path or None
        Where buffers in files of their own may lie; None allows none.
    limits : ReadLimits

    Raises
    ------
    ReadError
        For a broken container or a buffer that is not there.
    FormatError
        For glTF 1 and for compressed geometry.
    """
    is_binary = data[:4] == b"glTF"
    text, binary, chunks = _split_chunks(data) if is_binary else (data, None, [])
    document = _parse_json(text)
    asset = document.get("asset")
    if not isinstance(asset, dict) or not str(asset.get("version", "")).startswith("2"):
        raise FormatError("only glTF of version 2 is read")
    used = document.get("extensionsRequired")
    for extension in _COMPRESSED:
        if isinstance(used, list) and extension in used:
            raise FormatError(f"glTF compressed by {extension} is not read: send it uncompressed")
    buffers = _load_buffers(document, binary, folder, limits)
    return GltfFile(document, buffers, chunks, is_binary, data, folder)


def _split_chunks(data: bytes) -> tuple[bytes, bytes | None, list[tuple[int, bytes]]]:
    if len(data) < 20 or int.from_bytes(data[4:8], "little") != 2:
        raise FormatError("the GLB header names no version 2")
    stop = int.from_bytes(data[8:12], "little")
    if stop > len(data):
        raise ReadError(f"the GLB header declares {stop:,} bytes; the file has {len(data):,}")
    chunks: list[tuple[int, bytes]] = []
    at = 12
    while at + 8 <= stop:
        size, kind = int.from_bytes(data[at : at + 4], "little"), int.from_bytes(data[at + 4 : at + 8], "little")
        if at + 8 + size > stop:
            raise ReadError(f"GLB chunk {len(chunks)} declares {size:,} bytes; {stop - at - 8:,} are left")
        chunks.append((kind, data[at + 8 : at + 8 + size]))
        at += 8 + size
    if not chunks or chunks[0][0] != _JSON:
        raise ReadError("the first GLB chunk is no JSON")
    if len(chunks) > 1 and chunks[1][0] == _BIN:
        return chunks[0][1], chunks[1][1], chunks[2:]
    return chunks[0][1], None, chunks[1:]


def _parse_json(text: bytes) -> dict[str, Any]:
    try:
        document = json.loads(text, parse_constant=_refuse_constant, parse_float=_finite)
    except (ValueError, RecursionError) as error:
        raise ReadError(f"the glTF document is no JSON: {str(error)[:120]}") from error
    if not isinstance(document, dict):
        raise ReadError("the glTF document is no JSON object")
    return document


def _refuse_constant(word: str) -> NoReturn:
    raise ReadError(f"the glTF document holds {word}, which JSON does not know")


def _finite(word: str) -> float:
    value = float(word)
    if not math.isfinite(value):
        raise ReadError(f"the glTF document holds the number {word[:40]}, which is out of range")
    return value


def _load_buffers(
    document: dict[str, Any], binary: bytes | None, folder: Path | None, limits: ReadLimits
) -> list[bytes]:
    buffers: list[bytes] = []
    listed = document.get("buffers", [])
    if not isinstance(listed, list) or not all(isinstance(buffer, dict) for buffer in listed):
        raise ReadError("the glTF document has buffers that are no list of objects")
    for number, buffer in enumerate(listed):
        uri = buffer.get("uri")
        if uri is None:
            buffers.append(binary if binary is not None and number == 0 else b"")
        else:
            buffers.append(_load_uri(str(uri), folder, limits))
        limits.check_bytes(sum(map(len, buffers)))
    return buffers


def _load_uri(uri: str, folder: Path | None, limits: ReadLimits) -> bytes:
    if uri.startswith("data:"):
        _, _, encoded = uri.partition(";base64,")
        try:
            return base64.b64decode(encoded, validate=True)
        except (binascii.Error, ValueError) as error:
            raise ReadError("a glTF buffer is no base64 data") from error
    shown = uri[:80]
    try:
        has_scheme = bool(urlsplit(uri).scheme or urlsplit(uri).netloc)
        path = None if folder is None else (folder / unquote(uri)).resolve()
        inside = path is not None and folder is not None and path.is_relative_to(folder.resolve())
        if has_scheme or path is None or not inside:
            raise ReadError(f"the glTF buffer {shown!r} lies outside the mesh's folder: send a .glb with all in it")
        limits.check_bytes(path.stat().st_size)
        return path.read_bytes()
    except (OSError, ValueError) as error:
        raise ReadError(f"the glTF buffer {shown!r} is not there: send a .glb with all in it") from error


def dump_gltf(file: GltfFile) -> bytes:
    """Put a glTF file together again.

    A `.glb` keeps its first buffer as the binary chunk if that buffer has no address; all other buffers become part
    of the document, so the result is one file.
    """
    document = dict(file.document)
    listed = []
    binary = b""
    for number, (old, data) in enumerate(zip(document.get("buffers", []), file.buffers, strict=True)):
        entry = {**old, "byteLength": len(data)}
        if file.is_binary and number == 0 and "uri" not in entry:
            binary = data + bytes(-len(data) % 4)
        else:
            entry["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        listed.append(entry)
    if listed:
        document["buffers"] = listed
    if not file.is_binary:
        return json.dumps(document, indent=1).encode()
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = [(_JSON, text), *([(_BIN, binary)] if binary else []), *file.chunks]
    body = b"".join(len(data).to_bytes(4, "little") + kind.to_bytes(4, "little") + data for kind, data in chunks)
    return b"glTF" + (2).to_bytes(4, "little") + (len(body) + 12).to_bytes(4, "little") + body
