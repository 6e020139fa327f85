"""Whole meshes rebuilt from codes over the paper's local dictionary, by its number of atoms.

The error is the root mean square distance of the rebuilt vertices from the true surface. Vertices that no patch sees
keep their place and don't count.

References
----------
K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019, sections 4 and 5.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from benchmarks.quality.bench import BenchError, Shape
from benchmarks.quality.measurement import Method
from benchmarks.quality.outcome import Outcome
from benchmarks.quality.paper_experiments import ATOMS, Paper, Series, curve_table
from benchmarks.quality.pictures import clay_of, is_turned_inside_out, turned
from benchmarks.quality.plots import atoms_plot, curve_plot
from benchmarks.quality.results import REBUILDINGS
from benchmarks.quality.sheets import TILE, Row, compose
from benchmarks.quality.tables import scientific
from quadpatch.inpainters.model_file import load_model
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.raycast import RayScene
from quadpatch.patches.scale import PatchScale
from quadpatch.preview.parts import part_of
from quadpatch.preview.viewpoints import overview
from quadpatch.reconstruction.coding import PatchDictionary
from quadpatch.reconstruction.whole_surface import ReconstructOptions, reconstruct
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.types import TriangleMesh

# Numbers of atoms whose rebuilt meshes are drawn; the atoms of the second are drawn as well.
DRAWN = (5, 100)


@dataclass(frozen=True)
class Rebuilder:
    """Rebuilds shapes from codes over local dictionaries of one scale, into a folder."""

    paper: Paper
    scale: PatchScale
    folder: Path

    def error(self, shape: Shape, n_atoms: int) -> float | None:
        """Give the error in mesh units; None where the shape has fewer patches than atoms."""
        method = self.paper.learner.local(shape, self.scale, n_atoms)
        found = self._measured(shape, n_atoms, method) if method else {}
        error = float(found["rms"]) if found.get("n_atoms") == n_atoms else None
        self.paper.progress.step(f"{shape.name}, {n_atoms} atoms: {scientific(error)} millionths")
        return error

    def path(self, shape: Shape, n_atoms: int) -> Path:
        """Where the rebuilt mesh lies."""
        return self.folder / f"{shape.name}_{n_atoms}_{self.scale.length:.4g}.ply"

    def dictionary(self, shape: Shape, n_atoms: int) -> Dictionary | None:
        """Give the dictionary; None where the shape has too few patches."""
        method = self.paper.learner.local(shape, self.scale, n_atoms)
        return _read_dictionary(method) if method else None

    def _measured(self, shape: Shape, n_atoms: int, method: Method) -> dict[str, Any]:
        key = {"rebuilt": shape.name, "sha256": shape.sha256, **method.key()}
        return self.paper.results.get(REBUILDINGS, key, lambda: self._rebuild(shape, n_atoms, method))

    def _rebuild(self, shape: Shape, n_atoms: int, method: Method) -> dict[str, Any]:
        truth, dictionary = self.paper.bench.read(shape.truth), _read_dictionary(method)
        options = ReconstructOptions.from_dict({"patches": method.options["patches"]})
        result = reconstruct(truth, PatchDictionary(dictionary), options)
        distance = distance_to_mesh(result.vertices[result.seen], truth)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.paper.bench.write(self.path(shape, n_atoms), TriangleMesh(result.vertices, truth.triangles))
        return {
            "n_atoms": dictionary.n_atoms,
            "n_nonzero": dictionary.n_nonzero,
            "n_patches": len(result.coded.sampled.patches),
            "rms": float(np.sqrt((distance**2).mean())),
            "seen": float(result.seen.mean()),
        }


def rebuilding_experiment(rebuilder: Rebuilder, shapes: Sequence[Shape]) -> Outcome:
    """Measure rebuilt meshes against the number of atoms of a local dictionary, and draw some of them."""
    errors: Series = {shape.name: [rebuilder.error(shape, n_atoms) for n_atoms in ATOMS] for shape in shapes}
    title = f"error of rebuilt meshes by atoms, millionths, local dictionary, patch length {rebuilder.scale.length:.3g}"
    plots: dict[str, Figure | Image.Image] = {
        "curve": curve_plot(title, ("atoms", "error / millionths"), ATOMS, _in_millionths(errors)),
        **_atoms(rebuilder, shapes[0]),
        **_five_and_hundred(rebuilder, shapes, errors),
    }
    data = {"atoms": list(ATOMS), "length": rebuilder.scale.length, "errors": errors}
    return Outcome("rebuilding", [curve_table(title, ATOMS, errors, scientific)], data, plots)


def _atoms(rebuilder: Rebuilder, shape: Shape) -> dict[str, Figure | Image.Image]:
    dictionary = rebuilder.dictionary(shape, DRAWN[1])
    if dictionary is None:
        return {}
    return {"atoms": atoms_plot(f"{shape.name}: the {dictionary.n_atoms} atoms of its dictionary", dictionary)}


def _five_and_hundred(rebuilder: Rebuilder, shapes: Sequence[Shape], errors: Series) -> dict[str, Figure | Image.Image]:
    """Draw the true mesh and the rebuilt ones in the same view, a row for each shape that all of them are there of."""
    rows = []
    for shape in shapes:
        of_shape = {n_atoms: errors[shape.name][ATOMS.index(n_atoms)] for n_atoms in DRAWN}
        if all(error is not None and rebuilder.path(shape, n_atoms).is_file() for n_atoms, error in of_shape.items()):
            rows.append(_row(rebuilder, shape, {n: error for n, error in of_shape.items() if error is not None}))
    return {"five_and_hundred": compose(rows)} if rows else {}


def _row(rebuilder: Rebuilder, shape: Shape, errors: dict[int, float]) -> Row:
    bench = rebuilder.paper.bench
    as_stored = bench.read(shape.truth)
    is_flipped = is_turned_inside_out(as_stored)
    truth = turned(as_stored, is_flipped)
    camera = overview(RayScene(truth), part_of(truth, np.arange(len(truth.triangles))), None, 1.0)
    meshes = {"truth": truth}
    for n_atoms, error in errors.items():
        name = f"{n_atoms} atoms: error {scientific(error)} millionths of the object's size"
        meshes[name] = turned(bench.read(rebuilder.path(shape, n_atoms)), is_flipped)
    return Row(shape.name, {name: clay_of(mesh).draw(camera, (TILE, TILE)) for name, mesh in meshes.items()})


def _read_dictionary(method: Method) -> Dictionary:
    dictionary = load_model(method.model).dictionary
    if dictionary is None:
        raise BenchError(f"{method.model} is no dictionary")
    return dictionary


def _in_millionths(series: Series) -> Series:
    return {name: [None if v is None else 1e6 * v for v in values] for name, values in series.items()}
