"""Log files of programs: their end, for a message that explains why one did not start, and their bound."""

import os
import shutil
from pathlib import Path


def log_tail(path: Path, start: int = 0, n_lines: int = 12) -> str:
    """Last lines of a log file under a heading with its path; a plain note if there is nothing in it.

    Parameters
    ----------
    path : Path
    start : int
        Bytes at the beginning that belong to an earlier run.
    n_lines : int
    """
    text = path.read_bytes()[start:].decode(errors="replace") if path.exists() else ""
    lines = text.splitlines()[-n_lines:]
    if not lines:
        return f"its log, {path}, is empty"
    return f"the end of its log, {path}:\n" + "\n".join("  " + line for line in lines)


def start_anew(path: Path) -> None:
    """Move what a log holds into `{path}.1`, and empty it under the program that appends to it.

    The program keeps its file: a line that it writes between the end of the copy and the cut is lost. Both are
    system calls that follow each other.
    """
    with path.open("rb") as source, path.with_suffix(".log.1").open("wb") as target:
        shutil.copyfileobj(source, target)
        os.truncate(path, 0)
