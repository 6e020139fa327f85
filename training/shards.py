"""Patch corpora on disk: a folder with a manifest, and one array file for each mesh and named array.

The arrays are memory-mapped, so a corpus may be larger than memory and training starts at once. Patches are split by
mesh: all of one mesh are either for training or for validation. `manifest.json` is written last; a folder without it
is no corpus. Its `sha256` is over everything else in it, the sha256 of every array file among it.
"""

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.errors import OptionError
from quadpatch.types import IntArray
from training.errors import CorpusError
from training.sources import Source

FORMAT = 1
MANIFEST = "manifest.json"
SPLITS = ("train", "validation")

Array = np.ndarray[Any, np.dtype[Any]]
Arrays = dict[str, Array]
Facts = dict[str, Any]


@dataclass(frozen=True)
class PatchSet:
    """The patches of one split, as if joined.

    Attributes
    ----------
    shards : list of dict
        For each mesh its arrays (count, ...), by name.
    """

    shards: list[Arrays]

    def __len__(self) -> int:
        """Count of patches."""
        return int(self._ends()[-1]) if self.shards else 0

    def gather(self, rows: IntArray) -> Arrays:
        """Copy patches out of the files.

        Parameters
        ----------
        rows : (n,) int64
            Between 0 and the count; in any order, repeats allowed.

        Returns
        -------
        dict of str to (n, ...) array
        """
        shard_of = np.searchsorted(self._ends(), rows, side="right")
        starts = np.concatenate([[0], self._ends()])
        gathered = {name: np.zeros((len(rows), *a.shape[1:]), a.dtype) for name, a in self.shards[0].items()}
        for shard in np.unique(shard_of).tolist():
            places = np.flatnonzero(shard_of == shard)
            for name, array in self.shards[shard].items():
                gathered[name][places] = array[rows[places] - starts[shard]]
        return gathered

    def _ends(self) -> IntArray:
        return np.cumsum([len(next(iter(shard.values()))) for shard in self.shards], dtype=np.int64)


@dataclass(frozen=True)
class Corpus:
    """An opened corpus.

    Attributes
    ----------
    folder : Path
    manifest : dict
        `facts` (recipe, resolution, how patches were cut), `meshes`, `sha256`.
    """

    folder: Path
    manifest: dict[str, Any]

    @classmethod
    def open(cls, folder: Path) -> "Corpus":
        """Open a corpus and check that its manifest is whole.

        Raises
        ------
        CorpusError
            If there is none, or the manifest was changed after it was written.
        """
        try:
            manifest = json.loads((folder / MANIFEST).read_text("utf-8"))
            is_whole = manifest["format"] == FORMAT and manifest["sha256"] == _digest(manifest)
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise CorpusError(f"{folder} is no corpus of patches: {error}") from error
        if not is_whole:
            raise CorpusError(f"{folder / MANIFEST} was changed after it was written, or is of another version")
        return cls(folder, manifest)

    @property
    def facts(self) -> Facts:
        """How the patches were cut: `recipe`, `resolution` and more."""
        facts: Facts = self.manifest["facts"]
        return facts

    @property
    def sha256(self) -> str:
        """Hash of the corpus, in hex."""
        return str(self.manifest["sha256"])

    def meshes(self, split: str) -> list[dict[str, Any]]:
        """Manifest entries of the meshes of a split."""
        return [mesh for mesh in self.manifest["meshes"] if mesh["split"] == split]

    def patches(self, split: str) -> PatchSet:
        """Map the arrays of all meshes of a split that gave a patch.

        Raises
        ------
        CorpusError
            If a file is missing or is not what the manifest says.
        """
        return PatchSet([self._map(mesh) for mesh in self.meshes(split) if mesh["count"]])

    def verify(self) -> None:
        """Read all files and compare them with the manifest; raises CorpusError."""
        for mesh in self.manifest["meshes"]:
            for entry in mesh["files"].values():
                if _file_digest(self.folder / entry["name"]) != entry["sha256"]:
                    raise CorpusError(f"{self.folder / entry['name']} is not the file that was written")

    def _map(self, mesh: dict[str, Any]) -> Arrays:
        arrays: Arrays = {}
        for name, entry in mesh["files"].items():
            path = self.folder / Path(entry["name"]).name
            try:
                arrays[name] = np.load(path, mmap_mode="r", allow_pickle=False)
            except (OSError, ValueError, EOFError) as error:
                raise CorpusError(f"{path} can't be mapped: {error}") from error
            if arrays[name].shape[:1] != (mesh["count"],):
                raise CorpusError(f"{path} holds {arrays[name].shape[:1]} patches; the manifest says {mesh['count']}")
        return arrays


class CorpusWriter:
    """Writes a corpus mesh by mesh.

    Parameters
    ----------
    folder : Path
        Made if need be; must be empty.
    facts : dict
        JSON-ready; `recipe` and `resolution` at least.

    Raises
    ------
    OptionError
        If there is something in the folder.
    """

    def __init__(self, folder: Path, facts: Facts) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        if any(folder.iterdir()):
            raise OptionError(f"{folder} is not empty; a corpus wants a folder of its own")
        self._folder, self._facts = folder, facts
        self._meshes: list[dict[str, Any]] = []

    def add(self, source: Source, split: str, arrays: Arrays) -> None:
        """Write the patches of one mesh: arrays (count, ...), the same names for every mesh."""
        number, files = len(self._meshes), {}
        for name, array in sorted(arrays.items()):
            path = self._folder / f"{number:04d}-{name}.npy"
            np.save(path, array, allow_pickle=False)
            files[name] = {"name": path.name, "sha256": _file_digest(path)}
        count = len(next(iter(arrays.values())))
        self._meshes.append({**source.facts(), "split": split, "count": count, "files": files})

    def finish(self) -> Corpus:
        """Write the manifest and open what was written."""
        manifest = {"format": FORMAT, "facts": self._facts, "meshes": self._meshes}
        manifest["sha256"] = _digest(manifest)
        (self._folder / MANIFEST).write_text(json.dumps(manifest, indent=1) + "\n", "utf-8")
        return Corpus.open(self._folder)


def _digest(manifest: dict[str, Any]) -> str:
    rest = {key: value for key, value in manifest.items() if key != "sha256"}
    return hashlib.sha256(json.dumps(rest, sort_keys=True).encode()).hexdigest()


def _file_digest(path: Path) -> str:
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise CorpusError(f"{path} can't be read: {error}") from error
