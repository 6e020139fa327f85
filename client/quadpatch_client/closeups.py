"""Close-ups of holes: a ZIP file from the service becomes pictures in a folder.

What the file holds is checked before anything is written: the service may be another program, and a ZIP file may name
files anywhere and grow to any size.

Tested in `tests/attacks/test_j_client_closeups.py`.
"""

import os
import re
import tempfile
import zipfile
from pathlib import Path

from quadpatch_client.errors import ClientError, UsageError
from quadpatch_client.outputs import current_umask, descriptor_of, is_same_file

MOST_PICTURES = 1000
MOST_BYTES = 256 << 20
_NAME = re.compile(r"hole_[0-9]{1,10}\.png")
_PNG = b"\x89PNG\r\n\x1a\n"


def check_closeups_folder(folder: Path, files: list[Path]) -> None:
    """Raise UsageError where close-ups can't be put into a folder, or one would overwrite another file.

    Parameters
    ----------
    folder : Path
        May be missing; the folder that it lies in may not.
    files : list of Path
        The scan, and where other outputs go.
    """
    if descriptor_of(folder) is not None or (folder.exists() and not folder.is_dir()):
        raise UsageError(f"{folder} is no folder: close-ups are several files")
    parent = folder.resolve().parent
    if not parent.is_dir():
        raise UsageError(f"{folder} can't be made: there is no folder {parent}")
    for path in files:
        if _NAME.fullmatch(path.name) and is_same_file(path.parent, folder):
            raise UsageError(f"{path} has the name of a close-up in {folder}: name another file or folder")


def unpack_closeups(archive: Path, folder: Path) -> list[Path]:
    """Put the pictures of an archive into a folder, each of them whole or not at all.

    Parameters
    ----------
    archive : Path
    folder : Path
        Made where it is missing. A link of a picture's name is replaced, not followed.

    Returns
    -------
    list of Path
        In the order of the archive: the widest hole first.

    Raises
    ------
    ClientError
        If it is no archive, or holds anything but a bounded number of pictures `hole_<id>.png` of a bounded size;
        then nothing of it is written.
    """
    if archive.stat().st_size > MOST_BYTES:
        raise _too_much()
    try:
        with zipfile.ZipFile(archive) as pack:
            entries = pack.infolist()
            _check(entries)
            pictures = {entry.filename: pack.read(entry) for entry in entries}
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError, ValueError) as error:
        raise ClientError("the close-ups that came are no readable ZIP file") from error
    if not all(picture.startswith(_PNG) for picture in pictures.values()):
        raise ClientError("the close-ups that came are no PNG files")
    folder.resolve().mkdir(exist_ok=True)
    return [_write(folder / name, picture) for name, picture in pictures.items()]


def _check(entries: list[zipfile.ZipInfo]) -> None:
    names = [entry.filename for entry in entries]
    if len(names) > MOST_PICTURES or sum(entry.file_size for entry in entries) > MOST_BYTES:
        raise _too_much()
    if len(set(names)) < len(names) or not all(_NAME.fullmatch(name) for name in names):
        raise ClientError("the close-ups that came hold files of other names than hole_<id>.png")
    # A compressed entry may grow without end. PNG files are compressed already, and the service packs them as they are.
    if any(entry.compress_type != zipfile.ZIP_STORED or entry.compress_size != entry.file_size for entry in entries):
        raise ClientError("the close-ups that came are compressed once more, which is not read here")


def _too_much() -> ClientError:
    return ClientError(f"the close-ups that came are more than {MOST_PICTURES} files or {MOST_BYTES >> 20} MiB")


def _write(target: Path, picture: bytes) -> Path:
    descriptor, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", suffix=".part")
    partial = Path(name)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(picture)
        partial.chmod(0o666 & ~current_umask())
        partial.replace(target)
    finally:
        partial.unlink(missing_ok=True)
    return target
