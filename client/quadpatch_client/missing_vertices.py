"""`--missing`: which vertices of a scan are to be restored.

Tested in `tests/quadpatch_client/test_task_commands.py`.
"""

import json
from pathlib import Path
from typing import Any

from quadpatch_client.errors import UsageError

_PROPERTY = "property:"


def read_missing(text: str) -> dict[str, Any]:
    """Read the option as a job spec has it.

    Parameters
    ----------
    text : str
        `nan`, the name of a vertex property (`property:NAME` where a file has that name), or a file with the numbers
        of the vertices: a JSON list, or numbers between white space.

    Raises
    ------
    UsageError
        If the file can't be read, or holds anything else.
    """
    if text == "nan":
        return {"kind": "nan"}
    if text.startswith(_PROPERTY):
        return {"kind": "property", "name": text.removeprefix(_PROPERTY)}
    path = Path(text)
    if path.is_file():
        return {"kind": "indices", "indices": _read_indices(path)}
    return {"kind": "property", "name": text}


def _read_indices(path: Path) -> list[int]:
    try:
        text = path.read_text(encoding="utf-8")
        indices = json.loads(text) if text.lstrip().startswith("[") else [int(word) for word in text.split()]
    except (OSError, ValueError) as error:
        raise UsageError(f"{path} holds no list of vertex numbers: {error}") from error
    if not all(isinstance(index, int) and not isinstance(index, bool) for index in indices):
        raise UsageError(f"{path} holds something else than whole numbers")
    return list(indices)
