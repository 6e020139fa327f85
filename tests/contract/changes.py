"""What a client of an earlier version would stumble over in a later one.

`python -m tests.contract.changes [BEFORE [AFTER]]` compares two documents, or the document of a revision of git with
the present one, and exits with 1 where a change breaks clients. Without BEFORE it takes the last tag.

api-smart-diff compares. A field that is gone from an answer counts as a break here as well.
"""

import json
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.contract.tools import DOCUMENT, NODE, ROOT, run_node


@dataclass(frozen=True)
class Change:
    """A change of the document.

    Attributes
    ----------
    action : str
        `add`, `remove`, `replace` or `rename`.
    place : str
        JSON pointer.
    is_breaking : bool
    """

    action: str
    place: str
    is_breaking: bool


def changes(before: Path, after: Path) -> list[Change]:
    """List what has changed between two documents."""
    done = run_node(["node", str(NODE / "changes.mjs"), str(before), str(after)])
    if done.returncode:
        raise RuntimeError(done.stderr)
    return [_change(found) for found in json.loads(done.stdout)]


def _change(found: Mapping[str, Any]) -> Change:
    steps = [str(step) for step in found["path"]]
    is_gone = found["action"] == "remove" and "responses" in steps and steps[-2:-1] == ["properties"]
    return Change(found["action"], "/" + "/".join(steps), found["type"] == "breaking" or is_gone)


def main(arguments: list[str]) -> int:
    """Compare, and say what breaks clients; return the exit code."""
    with tempfile.TemporaryDirectory() as folder:
        before = _document(arguments[0] if arguments else _last_tag(), Path(folder) / "before.yaml")
        after = Path(arguments[1]) if arguments[1:] else DOCUMENT
        breaks = [change for change in changes(before, after) if change.is_breaking]
    for change in breaks:
        sys.stdout.write(f"{change.action} {change.place}\n")
    sys.stdout.write(f"{len(breaks)} changes break clients\n")
    return 1 if breaks else 0


def _last_tag() -> str:
    return _git("describe", "--tags", "--abbrev=0").strip()


def _document(name: str, path: Path) -> Path:
    """Return a document that is a file, or write that of a revision to a path."""
    if Path(name).is_file():
        return Path(name)
    path.write_text(_git("show", f"{name}:openapi.yaml"), "utf-8")
    return path


def _git(*arguments: str) -> str:
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=True).stdout


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
