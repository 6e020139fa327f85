"""Files that can't be repaired, moved into a folder of their own with the reason beside them.

Tested in `tests/quadpatch_client/test_folder_watch.py`.
"""

import os
from datetime import UTC, datetime
from itertools import count
from pathlib import Path

from quadpatch_client.file_repair import Row
from quadpatch_client.journal import sync


def set_aside(path: Path, folder: Path, row: Row) -> Path:
    """Move a file away, and return where it is.

    The reason is on the disk before the file is moved: whatever lies in the folder says why. A client that dies in
    between finds the file where it was.

    Parameters
    ----------
    path : Path
    folder : Path
        Made where it is missing.
    row : Row
        What came of the file.
    """
    folder.mkdir(exist_ok=True)
    target = _free_name(folder, path)
    reason = target.with_name(f"{target.name}.reason.txt")
    when = datetime.now(UTC).isoformat(timespec="seconds")
    job = f"job: {row.job}\n" if row.job else ""
    text = f"{path.name} was not repaired.\nwhy: {row.reason}\nwhen: {when}\n{job}To try again, move it back.\n"
    with reason.open("w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    path.replace(target)
    sync(folder)
    sync(path.parent)
    return target


def _free_name(folder: Path, path: Path) -> Path:
    """Return a name that no earlier file has: `scan.ply`, else `scan-2.ply` and so on."""
    names = (path.name if n == 1 else f"{path.stem}-{n}{path.suffix}" for n in count(1))
    return next(folder / name for name in names if not (folder / name).exists())
