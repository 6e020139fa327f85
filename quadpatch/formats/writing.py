"""Writing a repaired scan: in its own format as the file that came in with the fill appended, else converted."""

from pathlib import Path

from quadpatch.errors import FormatError
from quadpatch.files import write_whole
from quadpatch.formats.conversion import encode_as_obj, encode_as_off, encode_as_ply, encode_as_stl
from quadpatch.formats.gltf.encoder import encode_as_glb, encode_as_gltf
from quadpatch.formats.scan import Fill, Scan
from quadpatch.formats.threemf.encoder import encode_as_threemf
from quadpatch.formats.whole import assemble

_ENCODERS = {
    "ply": encode_as_ply,
    "stl": encode_as_stl,
    "obj": encode_as_obj,
    "off": encode_as_off,
    "glb": encode_as_glb,
    "gltf": encode_as_gltf,
    "3mf": encode_as_threemf,
}


def check_suffix(path: Path) -> None:
    """Raise FormatError where the suffix of a file is that of no format that is written."""
    if path.suffix.lower().lstrip(".") not in _ENCODERS:
        raise FormatError(f"files with the suffix {path.suffix!r} are not written, only {', '.join(_ENCODERS)}")


def write_scan(path: Path, scan: Scan, fill: Fill) -> None:
    """Write a scan with a fill appended.

    Parameters
    ----------
    path : Path
        Its suffix says the format. The scan's own format gives the file that was read, with the fill behind it and
        everything else as it was; another one is a conversion.
    scan : Scan
    fill : Fill

    Raises
    ------
    FormatError
        If the suffix is that of no format that is written, or the format can't hold the mesh.
    OSError
        If the file can't be written; what was there before stays.
    """
    check_suffix(path)
    suffix = path.suffix.lower().lstrip(".")
    if suffix == scan.format and scan.source is not None:
        data = scan.source.append(scan, fill)
    else:
        data = _ENCODERS[suffix](assemble(scan, fill))
    write_whole(path, data)
