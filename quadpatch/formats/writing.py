"""Writing a repaired scan: in its own format as the file that came in with the fill appended, else converted."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from quadpatch.errors import FormatError
from quadpatch.formats.conversion import encode_as_obj, encode_as_off, encode_as_ply, encode_as_stl
from quadpatch.formats.merged_scene import MergedScene, merge_scene
from quadpatch.formats.output_files import is_stream, write_whole
from quadpatch.formats.scan import FileBytes, Fill, Scan, Source
from quadpatch.stages import failure_of
from quadpatch_rules.coded_warnings import warning
from quadpatch_rules.option_words import CarriedAttribute


def _encode_as_glb(scene: MergedScene) -> bytes:
    from quadpatch.formats.gltf.encoder import encode_as_glb  # noqa: PLC0415  other formats do without it

    return encode_as_glb(scene)


def _encode_as_gltf(scene: MergedScene) -> bytes:
    from quadpatch.formats.gltf.encoder import encode_as_gltf  # noqa: PLC0415  see above

    return encode_as_gltf(scene)


def _encode_as_threemf(scene: MergedScene) -> bytes:
    from quadpatch.formats.threemf.encoder import encode_as_threemf  # noqa: PLC0415  see above

    return encode_as_threemf(scene)


ENCODERS = {
    "ply": encode_as_ply,
    "stl": encode_as_stl,
    "obj": encode_as_obj,
    "off": encode_as_off,
    "glb": _encode_as_glb,
    "gltf": _encode_as_gltf,
    "3mf": _encode_as_threemf,
}


# Formats that have images in files of their own.
_WITH_SIDE_FILES = ("obj", "ply")


def check_suffix(path: Path) -> None:
    """Raise FormatError where the suffix of a file is that of no format that is written; a stream needs none."""
    if is_stream(path) and not path.suffix:
        return
    if path.suffix.lower().lstrip(".") not in ENCODERS:
        raise FormatError(f"files with the suffix {path.suffix!r} are not written, only {', '.join(ENCODERS)}")


def written_as(path: Path, scan: Scan) -> Path:
    """Return a name whose suffix says the format that an output is written in: that of the scan for a stream."""
    return path if path.suffix or not is_stream(path) else Path(f"{path.name}.{scan.format}")


def write_scan(path: Path, scan: Scan, fill: Fill, attributes: Sequence[CarriedAttribute] | None = None) -> list[str]:
    """Write a scan with a fill appended.

    Parameters
    ----------
    path : Path
        Its suffix says the format; a stream without one gets that of the scan. The scan's own format gives the file
        that was read, with the fill behind it and everything else as it was; another one is a conversion.
    scan : Scan
    fill : Fill
    attributes : sequence of str, optional
        What a conversion carries besides the shape; None: all that both formats know.

    Returns
    -------
    list of str
        Warnings: one where what the scan carries besides its shape could not be carried on, and was left out.

    Raises
    ------
    FormatError
        If the suffix is that of no format that is written, or the format can't hold the mesh.
    OSError
        If the file can't be written; what was there before stays.
    """
    check_suffix(path)
    suffix = written_as(path, scan).suffix.lower().lstrip(".")
    data, warnings = _encode(suffix, scan, fill, attributes)
    if fill.page is not None and scan.source is not None and not warnings:
        for name, side in scan.source.side_files(fill.page).items():
            write_whole(path.resolve().parent / name, side)
    write_whole(path, data)
    return warnings


def takes_page(scan: Scan, path: Path) -> bool:
    """Whether an output can be given a texture page: the scan's own format, and where the files beside it may lie."""
    suffix = written_as(path, scan).suffix.lower().lstrip(".")
    return _own_format(suffix, scan) and (suffix not in _WITH_SIDE_FILES or not is_stream(path))


def _own_format(suffix: str, scan: Scan) -> bool:
    """Whether a format is that of the scan, or the binary form of it."""
    return suffix == scan.format or (suffix == "glb" and scan.format == "gltf")


def _as_binary(source: Source) -> Source:
    from quadpatch.formats.gltf.source import GltfSource  # noqa: PLC0415  see above

    return source.as_binary() if isinstance(source, GltfSource) else source


def _encode(
    suffix: str, scan: Scan, fill: Fill, attributes: Sequence[CarriedAttribute] | None
) -> tuple[FileBytes, list[str]]:
    """Encode with colours, normals and the like; where these fail, the shape alone."""
    encoded: list[FileBytes] = []

    def with_attributes() -> None:
        if _own_format(suffix, scan) and scan.source is not None:
            source = scan.source if suffix == scan.format else _as_binary(scan.source)
            encoded.append(source.append(scan, fill))
        else:
            encoded.append(ENCODERS[suffix](merge_scene(scan, fill).with_attributes(attributes)))

    failure = failure_of(with_attributes, passing=(FormatError,))
    if failure is None:
        return encoded[0], []
    bare = replace(scan, source=None)
    return ENCODERS[suffix](merge_scene(bare, fill)), [warning("attributes_left_out", reason=failure)]
