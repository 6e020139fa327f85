"""A bench of one's own: a script with the functions of the real one, on numpy files, and two shapes."""

import json
from pathlib import Path

import numpy as np

from benchmarks.quality.bench import Bench
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import bumpy_plate

SCRIPT = """
import json
import numpy as np

def read_ply(path):
    with np.load(path) as file:
        return file["vertices"], file["triangles"]

def write_ply(path, vertices, triangles):
    with open(path, "wb") as file:
        np.savez(file, vertices=vertices, triangles=triangles)

def punch(truth, radius, out):
    out.mkdir(parents=True, exist_ok=True)
    vertices, triangles = read_ply(truth)
    write_ply(out / "punched.ply", vertices, triangles[1:])
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
