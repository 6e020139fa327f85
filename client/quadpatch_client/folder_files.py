"""Which files of a folder are meshes, and where what is made of them goes.

Tested in `tests/quadpatch_client/test_batch.py`.
"""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import get_args

from quadpatch_client.errors import UsageError
from quadpatch_client.file_repair import FilePlan
from quadpatch_rules.option_words import OutputFormat

SUFFIXES = frozenset({*(f".{name}" for name in get_args(OutputFormat)), ".gltf"})
_PARTIAL = ".*.part"


def mesh_files(folder: Path, is_recursive: bool, *left_out: Path) -> Iterator[Path]:
    """Yield the meshes of a folder by their suffixes, sorted; hidden files and folders are passed over.

    Parameters
    ----------
    folder : Path
    is_recursive : bool
        Whether to look into folders within it.
    *left_out : Path
        Folders that are not looked into.
    """
    passed_over = {path.resolve() for path in left_out}
    for place, folders, names in os.walk(folder):
        here = Path(place)
        inner = sorted(n for n in folders if not n.startswith(".") and (here / n).resolve() not in passed_over)
        folders[:] = inner if is_recursive else []
        for name in sorted(names):
            if not name.startswith(".") and Path(name).suffix.lower() in SUFFIXES:
                yield here / name


def plans_in(
    sources: Iterator[Path], folder: Path, out: Path, format_: str | None, *, with_html: bool, with_preview: bool
) -> list[FilePlan]:
    """Return where each file of a folder goes in another one: under the same name, in the same folder within it.

    Raises
    ------
    UsageError
        If two files would go to one place.
    """
    plans, taken = [], dict[Path, Path]()
    for source in sources:
        name = source.relative_to(folder)
        output = out / (name.with_suffix(f".{format_}") if format_ else name)
        output = output.with_suffix(".glb") if output.suffix.lower() == ".gltf" else output
        report = output.with_name(f"{output.name}.report.json")
        html = output.with_name(f"{output.name}.report.html") if with_html else None
        preview = output.with_name(f"{output.name}.png") if with_preview else None
        plan = FilePlan(name.as_posix(), source, output, report, html, preview)
        for path in plan.outputs():
            if path in taken:
                raise UsageError(f"{taken[path]} and {source} would both become {path}: rename one of them")
            taken[path] = source
        plans.append(plan)
    return plans


def remove_partial_files(folder: Path) -> None:
    """Remove what a client that was killed has left of files that did not arrive whole."""
    for path in folder.rglob(_PARTIAL):
        path.unlink(missing_ok=True)
