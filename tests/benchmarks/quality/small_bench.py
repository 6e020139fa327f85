"""A bench of one's own: a script with the functions of the real one, which punches one hole, and two shapes."""

import json
from pathlib import Path

import numpy as np

from benchmarks.quality.bench import Bench
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import bumpy_plate

SCRIPT = """
import json
import numpy as np
import trimesh

def read_ply(path):
    mesh = trimesh.load(path, process=False)
    return np.array(mesh.vertices, np.float64), np.array(mesh.faces, np.int64)

def write_ply(path, vertices, triangles):
    trimesh.Trimesh(vertices, triangles, process=False).export(path)

def punch(truth, radius, out):
    out.mkdir(parents=True, exist_ok=True)
    vertices, triangles = read_ply(truth)
    is_far = np.linalg.norm(vertices[triangles].mean(axis=1)[:, :2], axis=1) > radius
    write_ply(out / "punched.ply", vertices, triangles[is_far])
    (out / "holes.json").write_text(json.dumps({"radius": radius, "holes": [{"id": 0, "centre": [0, 0, 0]}]}))

def score(truth, out, repaired):
    return {"error": 0.5}
"""
SHAPES = ("hills", "valleys")


def small_bench(folder: Path) -> Bench:
    """Write the bench and open it."""
    (folder / "meshes").mkdir(parents=True)
    (folder / "bench.py").write_text(SCRIPT)
    figures = {"0.1": {"fair": {"error": 0.25}}}
    (folder / "baselines.json").write_text(json.dumps(dict.fromkeys(reversed(SHAPES), figures)))
    bench = Bench.open(folder)
    for seed, name in enumerate(SHAPES):
        plate = bumpy_plate(41, 1.0, seed)
        rough = np.sin(40 * plate.vertices[:, 0] + seed) * np.sin(40 * plate.vertices[:, 1])
        vertices = plate.vertices + np.stack([0 * rough, 0 * rough, 0.01 * rough], axis=1)
        bench.write(folder / "meshes" / f"{name}.ply", TriangleMesh(vertices, plate.triangles))
    return bench
