"""The meshes to learn from, and whom to thank for them.

A file `manifest.json` beside the meshes, a list of objects with `name` (the file's stem) and `licence`, says where
they come from. Meshes without an entry are named without a licence.
"""

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quadpatch.errors import OptionError, ReadError

MANIFEST = "manifest.json"
SUFFIXES = (".ply", ".stl", ".obj", ".off", ".glb", ".gltf", ".3mf")


@dataclass(frozen=True)
class Source:
    """One mesh file.

    Attributes
    ----------
    name : str
        Stem of the file.
    path : Path
    sha256 : str
        Of the file's bytes, in hex.
    licence, origin : str
        From the manifest; empty where it says nothing.
    """

    name: str
    path: Path
    sha256: str
    licence: str = ""
    origin: str = ""

    def facts(self) -> dict[str, str]:
        """Return what a card says about the mesh."""
        return {"name": self.name, "sha256": self.sha256, "licence": self.licence, "origin": self.origin}


def find_sources(paths: list[Path]) -> list[Source]:
    """List the mesh files that the paths name; a folder stands for all meshes in it, by name.

    Raises
    ------
    ReadError
        If a path is neither a file nor a folder, or a manifest is broken.
    """
    files: list[Path] = []
    for path in paths:
        if path.is_dir():
            files += sorted(p for p in path.iterdir() if p.suffix.lower() in SUFFIXES)
        elif path.is_file():
            files.append(path)
        else:
            raise ReadError(f"no mesh file and no folder {path}")
    return [_source(path) for path in dict.fromkeys(files)]


def split_holdout(sources: list[Source], holdout: list[str]) -> tuple[list[Source], list[Source]]:
    """Part the meshes into those to learn from and those, named by stem, to be kept for measuring.

    Raises
    ------
    OptionError
        If a name is not among the meshes.
    """
    missing = sorted(set(holdout) - {source.name for source in sources})
    if missing:
        raise OptionError(f"no mesh {missing[0]!r} to hold out; there are {', '.join(s.name for s in sources)}")
    kept = [source for source in sources if source.name not in holdout]
    return kept, [source for source in sources if source.name in holdout]


def corpus_sha256(parts: list[str]) -> str:
    """Hash of a corpus: of the sorted lines that name its parts."""
    return hashlib.sha256("\n".join(sorted(parts)).encode()).hexdigest()


def _source(path: Path) -> Source:
    entry = _manifest(path.parent).get(path.stem, {})
    origin = "/".join(str(entry[key]) for key in ("source_repo", "source_path") if entry.get(key))
    origin = origin or str(entry.get("origin", ""))
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    return Source(path.stem, path, digest, str(entry.get("licence", "")), origin)


def _manifest(folder: Path) -> dict[str, dict[str, Any]]:
    path = folder / MANIFEST
    if not path.is_file():
        return {}
    try:
        return {str(entry["name"]): entry for entry in json.loads(path.read_text("utf-8"))}
    except (ValueError, TypeError, KeyError) as error:
        raise ReadError(f"{path} is no list of meshes: {error}") from error
