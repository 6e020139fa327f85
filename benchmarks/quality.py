"""Repair quality on ground-truth meshes, beside what the peers reach.

Run ``python -m benchmarks.quality BENCH`` with the folder that holds ``bench.py`` (which punches holes and scores
repairs), ``meshes/`` and ``baselines.json``. Prints one table per hole radius, errors as ratios to the faired baseline
``fair``, and writes everything as JSON. Needs the `dev` extra.
Meshes of the bench are for measuring only: nothing here learns from them but
``--model self``, which sees the punched mesh alone.
"""

import argparse
import importlib.util
import json
import sys
import time
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import trimesh
from rich.console import Console
from rich.table import Table
from scipy.spatial import cKDTree
from scipy.stats import spearmanr

from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.repair import repair_file
from quadpatch.types import TriangleMesh

PEERS = ("fair", "meshlab_refine", "meshlib", "cgal")


def main() -> None:
    """Punch, repair, score, tabulate."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench", type=Path, help="folder of the bench")
    parser.add_argument("--model", action="append", help="smooth, self, or a model; repeat for more")
    parser.add_argument("--radius", action="append", help="hole radius as a share of the object's size")
    parser.add_argument("--mesh", action="append", help="just these meshes")
    parser.add_argument("--output", type=Path, default=Path("var/quality"), help="folder for meshes and results")
    arguments = parser.parse_args()
    bench = _load(arguments.bench / "bench.py")
    baselines = json.loads((arguments.bench / "baselines.json").read_text())
    models = arguments.model or ["smooth", "self", "general-dictionary"]
    rows = []
    for radius in arguments.radius or ["0.025"]:
        for name in arguments.mesh or sorted(baselines):
            truth = arguments.bench / "meshes" / f"{name}.ply"
            folder = arguments.output / f"{name}_{radius}"
            if not (folder / "punched.ply").is_file():
                bench.punch(truth, float(radius), folder)
            for model in models:
                rows.append({"mesh": name, "radius": radius, **_measure(bench, truth, folder, model)})
                _say(rows[-1], baselines[name][radius])
        _tabulate([row for row in rows if row["radius"] == radius], models, baselines, radius)
    (arguments.output / "quality.json").write_text(json.dumps(rows, indent=1) + "\n")


def _load(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location("bench", path)
    if spec is None or spec.loader is None or not path.is_file():
        sys.exit(f"there is no {path}")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _measure(bench: ModuleType, truth: Path, folder: Path, model: str) -> dict[str, Any]:
    """Repair one punched mesh with one model; errors, seconds, and every hole's true and expected error."""
    repaired = folder / f"{Path(model).stem}.ply"
    start = time.perf_counter()
    report = repair_file(folder / "punched.ply", repaired, model)
    seconds = time.perf_counter() - start
    holes = _true_errors(bench, truth, folder, repaired, report)
    return {"model": model, "seconds": seconds, **bench.score(truth, folder, repaired), "per_hole": holes}


def _true_errors(
    bench: ModuleType, truth: Path, folder: Path, repaired: Path, report: dict[str, Any]
) -> list[dict[str, Any]]:
    """Mean distance of every punched hole's new vertices to the truth, next to what the report expected."""
    rows = trimesh.load(repaired, process=False).metadata["_ply_raw"]["vertex"]["data"]
    new = rows[rows["filled"] == 1]
    points = np.stack([new[axis] for axis in "xyz"], axis=1).astype(np.float64)
    distance = distance_to_mesh(points, TriangleMesh(*bench.read_ply(truth)))
    punched = json.loads((folder / "holes.json").read_text())
    centres = cKDTree(np.array([hole["centre"] for hole in punched["holes"]]))
    found = []
    for hole in report["holes"]:
        mine = new["hole_id"] == hole["id"]
        # Holes that the mesh had before the punch have no known truth.
        if mine.any() and centres.query(points[mine].mean(axis=0))[0] < punched["radius"]:
            keys = ("id", "verdict", "confidence", "expected_error")
            found.append({**{key: hole[key] for key in keys}, "true_error": float(distance[mine].mean())})
    return found


def _say(row: dict[str, Any], peers: dict[str, Any]) -> None:
    ratio = row["error"] / peers["fair"]["error"]
    Console(stderr=True).print(f"{row['mesh']} {row['radius']} {row['model']}: {ratio:.3f} in {row['seconds']:.1f} s")


def _tabulate(rows: list[dict[str, Any]], models: list[str], baselines: dict[str, Any], radius: str) -> None:
    table = Table(title=f"error / fair, hole radius {radius}")
    table.add_column("mesh")
    for name in (*models, *PEERS[1:]):
        table.add_column(name, justify="right")
    ratios: list[list[float]] = []
    for mesh in dict.fromkeys(row["mesh"] for row in rows):
        peers = baselines[mesh][radius]
        ours = {row["model"]: row["error"] for row in rows if row["mesh"] == mesh}
        errors = [*(ours[model] for model in models), *(peers[peer]["error"] for peer in PEERS[1:])]
        ratios.append([error / peers["fair"]["error"] for error in errors])
        table.add_row(mesh, *(f"{ratio:.3f}" for ratio in ratios[-1]))
    means = np.exp(np.log(np.array(ratios)).mean(axis=0))
    table.add_row("geometric mean", *(f"{mean:.3f}" for mean in means), style="bold")
    console = Console()
    console.print(table)
    for model in models:
        holes = [hole for row in rows if row["model"] == model for hole in row["per_hole"]]
        console.print(_confidence(model, holes))


def _confidence(model: str, holes: list[dict[str, Any]]) -> str:
    """How well the expected errors and the confidences of all holes tell the good fills from the bad ones."""
    true = np.array([hole["true_error"] for hole in holes])
    expected = np.array([hole["expected_error"] for hole in holes])
    worst_first = np.argsort([hole["confidence"] for hole in holes])
    tenth = max(1, len(holes) // 10)
    gap = true[worst_first[:tenth]].mean() / true[worst_first[tenth:]].mean()
    rank = spearmanr(expected, true).statistic
    return f"{model}: {len(holes)} holes, rank correlation {rank:.2f}, least confident tenth {gap:.1f} times worse"


if __name__ == "__main__":
    main()
