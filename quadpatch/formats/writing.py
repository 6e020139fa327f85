"""Handing a scan back with a fill appended."""

from pathlib import Path

from quadpatch.errors import FormatError
from quadpatch.formats.ply import PlySource
from quadpatch.formats.ply_writer import append_to_ply
from quadpatch.formats.scan import Fill, Scan


def write_scan(path: Path, scan: Scan, fill: Fill) -> None:
    """Write a scan with a fill appended.

    Parameters
    ----------
    path : Path
    scan : Scan
    fill : Fill
    """
    if path.suffix.lower() == ".ply" and isinstance(scan.source, PlySource):
        path.write_bytes(append_to_ply(scan, scan.source, fill))
        return
    raise FormatError(f"{path.suffix} can't be written from {scan.format}")
