"""Which files of a folder are meshes, and where what is made of them goes.

Tested in `tests/quadpatch_client/test_batch.py`.
"""

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import get_args

from quadpatch_client.errors import UsageError
from quadpatch_client.file_repair import FilePlan
from quadpatch_rules.option_words import OutputFormat

SUFFIXES = frozenset({*(f".{name}" for name in get_args(OutputFormat)), ".gltf"})
_PARTIAL = ".*.part"
_MOST_NAMED = 20


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
    for path in _files(folder, is_recursive, *left_out):
        if why_passed_over(path) is None:
            yield path


def passed_over(folder: Path, is_recursive: bool, *left_out: Path) -> dict[str, list[str]]:
    """Return the files of a folder that are no meshes by their names, by the reason; parameters as `mesh_files`."""
    found: dict[str, list[str]] = {}
    for path in _files(folder, is_recursive, *left_out):
        why = why_passed_over(path)
        if why is not None:
            found.setdefault(why, []).append(path.relative_to(folder).as_posix())
    return found


def inner_folders(folder: Path, *left_out: Path) -> list[str]:
    """Return the names of the folders in a folder that are neither hidden nor left out, sorted."""
    passed = {path.resolve() for path in left_out}
    found = [path for path in folder.iterdir() if path.is_dir() and not path.name.startswith(".")]
    return sorted(path.name for path in found if path.resolve() not in passed)


def passed_over_in_words(found: Mapping[str, Sequence[str]]) -> str:
    """Name the files that are passed over, at most 20 for each reason."""
    return "; ".join(f"{_some(names)} ({why})" for why, names in found.items())


def why_passed_over(path: Path) -> str | None:
    """Say why a file is not taken for a mesh; None where it is."""
    if path.name.startswith("."):
        return "hidden: the name begins with a dot"
    return None if path.suffix.lower() in SUFFIXES else "no suffix of a mesh"


def _some(names: Sequence[str]) -> str:
    more = f" and {len(names) - _MOST_NAMED:,} more" if len(names) > _MOST_NAMED else ""
    return ", ".join(names[:_MOST_NAMED]) + more


def _files(folder: Path, is_recursive: bool, *left_out: Path) -> Iterator[Path]:
    passed = {path.resolve() for path in left_out}
    for place, folders, names in os.walk(folder):
        here = Path(place)
        inner = sorted(n for n in folders if not n.startswith(".") and (here / n).resolve() not in passed)
        folders[:] = inner if is_recursive else []
        yield from (here / name for name in sorted(names))


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
