"""One run: a damaged mesh through files and back, and what the judge says of it.

Which mesh, which damage and which format follows from a seed and the number of the run. A fault of the output is fine
where the report names it: `measures.folds` and `measures.crossings` of the holes count them.
"""

import json
import traceback
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.surface_faults import find_faults_in_files
from quadpatch.errors import QuadpatchError
from quadpatch.options import HoleOptions, RepairOptions
from quadpatch.repair import repair_file
from quadpatch.types import TriangleMesh
from tests.fuzz.bases import any_base, with_long_rim
from tests.fuzz.damage import DAMAGES, blobs
from tests.quadpatch.shapes import write_ply

KINDS = tuple(DAMAGES)
_EVERYTHING = RepairOptions(HoleOptions(max_diameter=1e30))


@dataclass(frozen=True)
class Damaged:
    """A mesh to repair: the main kind of its damage, the format of its file, and the options."""

    kind: str
    mesh: TriangleMesh
    format: str
    options: RepairOptions


@dataclass(frozen=True)
class Outcome:
    """What became of one run.

    Attributes
    ----------
    kind : str
    number : int
    filled, refused : int
        Holes; a file that is refused as a whole counts as one.
    code : str
        Of the error where the file was refused.
    folds, crossings : int
        That the judge found.
    named_folds, named_crossings : int
        That the report names.
    is_kept : bool
    crash : str
        The traceback of an error without a code.
    """

    kind: str
    number: int
    filled: int = 0
    refused: int = 0
    code: str = ""
    folds: int = 0
    crossings: int = 0
    named_folds: int = 0
    named_crossings: int = 0
    is_kept: bool = True
    crash: str = ""

    @property
    def unnamed(self) -> int:
        """Faults of the output that the report does not name."""
        return max(self.folds - self.named_folds, 0) + max(self.crossings - self.named_crossings, 0)

    @property
    def is_sound(self) -> bool:
        """Whether nothing is wrong with the run."""
        return self.is_kept and not self.crash and not self.unnamed


def damaged(seed: int, number: int) -> Damaged:
    """Draw the mesh of a run; the main kinds of damage take turns."""
    rng = np.random.default_rng([seed, number])
    kind = KINDS[number % len(KINDS)]
    mesh = with_long_rim(rng) if kind == "long rims" else blobs(any_base(rng), rng)
    if rng.random() < 0.4 and kind != "holes":
        mesh = DAMAGES[str(rng.choice(KINDS[:-2]))](mesh, rng)
    mesh = DAMAGES[kind](mesh, rng)
    # In float32, a mesh a million units away is no surface any more.
    kinds = ["ply f8"] if kind == "offset" else ["ply f8", "ply f4", "stl"]
    chosen = str(rng.choice(kinds, p=[1.0] if len(kinds) == 1 else [0.6, 0.1, 0.3]))
    return Damaged(kind, mesh, chosen, _EVERYTHING if rng.random() < 0.3 else RepairOptions())


def run(seed: int, number: int, folder: Path) -> Outcome:
    """Repair the mesh of one run in a folder of its own, where its files stay."""
    case = damaged(seed, number)
    folder.mkdir(parents=True, exist_ok=True)
    suffix = "." + case.format.split()[0]
    source, output = folder / f"in{suffix}", folder / f"out{suffix}"
    if suffix == ".stl":
        write_stl(source, case.mesh)
    else:
        write_ply(source, case.mesh, case.format.split()[1])
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            report = repair_file(source, output, "smooth", case.options)
        (folder / "report.json").write_text(json.dumps(report, allow_nan=False))
    except QuadpatchError as error:
        return Outcome(case.kind, number, refused=1, code=error.code)
    except Exception:  # noqa: BLE001  an error without a code is what is looked for
        return Outcome(case.kind, number, crash=traceback.format_exc())
    return _judged(case.kind, number, source, output, report)


def _judged(kind: str, number: int, source: Path, output: Path, report: dict[str, Any]) -> Outcome:
    faults = find_faults_in_files(source, output)
    measures = [hole["measures"] for hole in report["holes"]]
    return Outcome(
        kind,
        number,
        filled=report["counts"]["filled_smooth"],
        refused=report["counts"]["refused"],
        folds=faults.n_folds,
        crossings=faults.n_crossings,
        named_folds=int(sum(row.get("folds", 0) for row in measures)),
        named_crossings=int(sum(row.get("crossings", 0) for row in measures)),
        is_kept=faults.is_kept,
    )


def write_stl(path: Path, mesh: TriangleMesh) -> Path:
    """Write a binary STL, which repeats the corners of every triangle, with normals of 0."""
    rows = np.zeros(len(mesh.triangles), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attributes", "<u2")])
    rows["corners"] = mesh.vertices[mesh.triangles]
    path.write_bytes(bytes(80) + np.uint32(len(rows)).tobytes() + rows.tobytes())
    return path
