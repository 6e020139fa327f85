"""The end of a log file, for a message that explains why something did not start."""

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
