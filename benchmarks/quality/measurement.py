"""One repair, measured: the bench's errors of the whole mesh, and the true error of every hole.

Tested in `tests/benchmarks/quality/test_bench.py`.
"""

import json
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from scipy.spatial import cKDTree

from benchmarks.quality.bench import Bench, Case, file_sha256
from benchmarks.quality.results import REPAIRS, Results
from quadpatch.inpainters.model_file import shipped_model
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.model_choice import AUTO, BASE_NETWORK, SELF, SELF_NETWORK, SMOOTH
from quadpatch.options import RepairOptions
from quadpatch.repair import repair_file
from quadpatch.types import IntArray, Vertices

# The effort of `auto` that may be named like a model.
BEST = "best"


@dataclass(frozen=True)
class Method:
    """A way to repair: a model and the options of the repair.

    Attributes
    ----------
    name : str
        For tables and file names.
    model : str
        `smooth`, `self`, `self-network`, a shipped model, or a path.
    options : dict
        As in a job; empty for the defaults.
    """

    name: str
    model: str
    options: dict[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, model: str) -> "Method":
        """Take a model with default options, named by its file's stem; `best` stands for `auto` with that effort."""
        if model == BEST:
            return cls(BEST, AUTO, {"effort": BEST})
        return cls(Path(model).stem if Path(model).is_file() else model, model)

    def key(self) -> dict[str, str]:
        """Name what results of this method depend on."""
        key = {"method": self.name, "options": json.dumps(self.options, sort_keys=True)}
        if self.model in (SMOOTH, SELF):
            return key
        # A network that is fitted to the mesh starts from one that ships, which competes in `auto` as well.
        name = BASE_NETWORK if self.model in {SELF_NETWORK, AUTO} else self.model
        path = Path(name) if Path(name).is_file() else shipped_model(name)
        return {**key, "model_sha256": file_sha256(path)}


def measure(bench: Bench, case: Case, method: Method, results: Results) -> dict[str, Any]:
    """Repair a case and measure it, or take what was kept.

    Returns
    -------
    dict
        What ``bench.score`` says, `seconds` of the repair, `stages`: seconds by stage, `n_patches` that were completed,
        and `per_hole`: id, verdict, confidence, expected and true error, and centre of each punched hole that got new
        vertices.
    """
    key = {"mesh": case.shape.name, "radius": case.radius, "sha256": case.shape.sha256, **method.key()}
    return results.get(REPAIRS, key, lambda: _repair(bench, case, method))


def repaired_path(case: Case, method: Method) -> Path:
    """Where the repaired mesh of the last run lies."""
    return case.folder / f"{method.name.replace('/', '-')}.ply"


def _repair(bench: Bench, case: Case, method: Method) -> dict[str, Any]:
    repaired = repaired_path(case, method)
    options = RepairOptions.from_dict(method.options)
    start = time.perf_counter()
    report = repair_file(case.punched, repaired, method.model, options)
    seconds = time.perf_counter() - start
    facts = {
        "model": method.model,
        "seconds": seconds,
        "stages": {stage["name"]: stage["seconds"] for stage in report["stages"]},
        "n_patches": (report["patches"] or {"count": 0})["count"],
    }
    return {**facts, **bench.score(case, repaired), "per_hole": _per_hole(bench, case, repaired, report)}


def new_vertices(repaired: Path) -> tuple[Vertices, IntArray]:
    """Positions (k, 3) of the invented vertices of a repaired PLY, and their holes' ids (k,)."""
    rows = trimesh.load(repaired, process=False).metadata["_ply_raw"]["vertex"]["data"]
    new = rows[rows["filled"] == 1]
    return np.stack([new[axis] for axis in "xyz"], axis=1).astype(np.float64), new["hole_id"].astype(np.int64)


def _per_hole(bench: Bench, case: Case, repaired: Path, report: dict[str, Any]) -> list[dict[str, Any]]:
    """Mean distance of every punched hole's new vertices to the truth, next to what the report expected."""
    points, hole_id = new_vertices(repaired)
    distance = distance_to_mesh(points, bench.read(case.shape.truth))
    punched = cKDTree(np.array([hole["centre"] for hole in case.holes()]))
    entries = []
    for hole in report["holes"]:
        is_of_hole = hole_id == hole["id"]
        centre = points[is_of_hole].mean(axis=0) if is_of_hole.any() else np.full(3, np.inf)
        # Holes that the mesh had before the punch have no known truth.
        if is_of_hole.any() and punched.query(centre)[0] < float(case.radius):
            facts = {key: hole[key] for key in ("id", "verdict", "code", "confidence", "expected_error")}
            entries.append({**facts, "true_error": float(distance[is_of_hole].mean()), "centre": centre.tolist()})
    return entries
