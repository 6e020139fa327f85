"""The bench: meshes with known truth, a script that punches and scores, and the errors that peers reach.

The folder holds ``bench.py``, ``meshes/NAME.ply`` and ``baselines.json`` (mesh, then hole radius, then peer). Its
meshes are normalised, longest side 1, so every length here is a share of the object's size. They are for measuring
only.
"""

import hashlib
import importlib.util
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from quadpatch.errors import NoQuadsError
from quadpatch.patches.paper_layout import cut_patches, measured_patches, smooth_for_quads
from quadpatch.patches.scale import PatchScale
from quadpatch.patches.seeds import Seeds
from quadpatch.types import Patches, TriangleMesh

RADII = ("0.015", "0.025", "0.035")


class BenchError(Exception):
    """The folder is no bench, or lacks what was asked for."""


@dataclass(frozen=True)
class Shape:
    """A mesh with known truth.

    Attributes
    ----------
    name : str
    truth : Path
        PLY, normalised.
    peers : dict
        Figures of ``bench.score`` by radius and peer; more may be computed on the spot.
    """

    name: str
    truth: Path
    peers: dict[str, dict[str, dict[str, Any]]]

    @property
    def sha256(self) -> str:
        """Hash of the truth: results of another mesh of the same name must not be taken for this one's."""
        return file_sha256(self.truth)


@dataclass(frozen=True)
class Case:
    """A shape with holes of one radius, in a folder with ``punched.ply`` and ``holes.json``."""

    shape: Shape
    radius: str
    folder: Path

    @property
    def punched(self) -> Path:
        """The mesh with the holes."""
        return self.folder / "punched.ply"

    @property
    def peers(self) -> dict[str, dict[str, Any]]:
        """Figures by peer; empty where none were measured."""
        return self.shape.peers.get(self.radius, {})

    def holes(self) -> list[dict[str, Any]]:
        """Id, centre and radius of the punched holes."""
        return list(json.loads((self.folder / "holes.json").read_text())["holes"])


@dataclass(frozen=True)
class Bench:
    """The bench's folder and its script."""

    folder: Path
    script: ModuleType
    _smoothed: dict[Path, TriangleMesh] = field(default_factory=dict)

    @classmethod
    def open(cls, folder: Path) -> "Bench":
        """Load ``bench.py`` from a folder; raises BenchError where there is none."""
        path = folder / "bench.py"
        spec = importlib.util.spec_from_file_location("bench", path) if path.is_file() else None
        if spec is None or spec.loader is None:
            raise BenchError(f"there is no {path}")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return cls(folder, module)

    def shapes(self) -> list[Shape]:
        """List the shapes by name."""
        baselines = json.loads((self.folder / "baselines.json").read_text())
        return [Shape(name, self.folder / "meshes" / f"{name}.ply", baselines[name]) for name in sorted(baselines)]

    def case(self, shape: Shape, radius: str, output: Path) -> Case:
        """Punch a shape, unless that was done before for this very truth."""
        case = Case(shape, radius, output / f"{shape.name}_{radius}")
        stamp = case.folder / "truth.sha256"
        if not (case.punched.is_file() and stamp.is_file() and stamp.read_text() == shape.sha256):
            self.script.punch(shape.truth, float(radius), case.folder)
            stamp.write_text(shape.sha256)
        return case

    def score(self, case: Case, repaired: Path) -> dict[str, Any]:
        """Errors of a repaired mesh over the punched holes, in unit-cube units."""
        scores: dict[str, Any] = self.script.score(case.shape.truth, case.folder, repaired)
        return scores

    def read(self, path: Path) -> TriangleMesh:
        """Read a PLY as the bench reads it."""
        return TriangleMesh(*self.script.read_ply(path))

    def smoothed(self, path: Path) -> TriangleMesh:
        """Read a PLY and smooth it as the paper's recipe does, which takes a minute; what was smoothed is kept."""
        if path not in self._smoothed:
            self._smoothed[path] = smooth_for_quads(self.read(path))
        return self._smoothed[path]

    def patches(self, path: Path, scale: PatchScale, seed: int = 0) -> Patches:
        """Cut the patches of a mesh as the paper's recipe does; none where it is too small to carry one."""
        rng = np.random.default_rng(seed)
        try:
            return cut_patches(self.read(path), self.smoothed(path), scale, rng)
        except NoQuadsError:
            nothing = Seeds(np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros(0, np.int64))
            return measured_patches(self.read(path), nothing, scale, rng)

    def write(self, path: Path, mesh: TriangleMesh) -> None:
        """Write a PLY as the bench writes it: float32."""
        self.script.write_ply(path, mesh.vertices, mesh.triangles)


def named(shapes: Sequence[Shape], names: Sequence[str]) -> list[Shape]:
    """Take the shapes of some names, all for none; raises BenchError for an unknown one."""
    by_name = {shape.name: shape for shape in shapes}
    unknown = sorted(set(names) - set(by_name))
    if unknown:
        raise BenchError(f"no mesh {unknown[0]!r}; there are {', '.join(sorted(by_name))}")
    return [by_name[name] for name in dict.fromkeys(names or by_name)]


def file_sha256(path: Path) -> str:
    """Hash of a file's bytes, in hex."""
    return hashlib.sha256(path.read_bytes()).hexdigest()
