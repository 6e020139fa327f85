"""Reports as files, and what a summary says of every task."""

import json
from pathlib import Path
from typing import Any

from quadpatch.formats.output_files import write_whole


def write_report(report: dict[str, Any], path: Path | None) -> None:
    """Write a report, if it was asked for."""
    if path:
        write_whole(path, (json.dumps(report, indent=2) + "\n").encode())


def closing_words(report: dict[str, Any]) -> str:
    """Say how long it took, and what to beware of."""
    seconds = sum(stage["seconds"] for stage in report["stages"])
    warnings = "".join(f" Warning: {warning}." for warning in report["warnings"])
    return f"{seconds:.1f} s.{warnings}"


def n_holes(count: int) -> str:
    """Write a number of holes."""
    return "1 hole" if count == 1 else f"{count} holes"
