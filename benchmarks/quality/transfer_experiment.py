"""One half of a mesh learns, the holes of the other are filled: the paper's stone wall.

A mesh is cut in two between its triangles. Holes are punched into the second half, and filled by dictionaries that
were learned from the first one, undamaged, or from the second itself before it was punched.

References
----------
K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019, section 5.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from benchmarks.denoising import halves
from benchmarks.quality.bench import Case, Shape
from benchmarks.quality.measurement import Method, measure, repaired_path
from benchmarks.quality.outcome import Outcome
from benchmarks.quality.paper_experiments import FAIR, MESHLAB, Paper
from benchmarks.quality.peers import with_peers
from benchmarks.quality.pictures import PUNCHED, TRUTH, DrawnCase, percent_of_radius
from benchmarks.quality.results import MODELS, Key
from benchmarks.quality.sheets import Row, compose
from benchmarks.quality.tables import Table, figure, ratio, scientific
from quadpatch.errors import OptionError
from quadpatch.inpainters.model_file import save_dictionary
from quadpatch.model_choice import SELF
from training.dictionary import LearningOptions, learn_dictionary
from training.sources import Source

DEFAULT_MESH = "relief_gyroid"
TRANSFERRED = "paper, other half"
# How many ways to repair are compared.
N_TRANSFERS = 4
# How the closing by MeshLab is called under a picture.
_CLOSING = "MeshLab's closing"


@dataclass(frozen=True)
class Halves:
    """The two halves of a shape as shapes of their own, not scaled again, and the second one punched."""

    name: str
    learned_from: Shape
    case: Case

    @classmethod
    def of(cls, paper: Paper, shape: Shape, radius: str, output: Path) -> "Halves":
        """Cut a shape across its longest side, write both halves to a folder, and punch the second."""
        folder = output / "halves"
        folder.mkdir(parents=True, exist_ok=True)
        shapes = []
        for side, half in zip(("first", "second"), halves(paper.bench.read(shape.truth)), strict=True):
            path = folder / f"{shape.name}_{side}.ply"
            paper.bench.write(path, half)
            shapes.append(Shape(f"{shape.name}_{side}", path, {}))
        case = with_peers(paper.bench, paper.bench.case(shapes[1], radius, output), paper.results)
        return cls(shape.name, shapes[0], case)


def transfer_experiment(
    paper: Paper, shapes: Sequence[Shape], every: Sequence[Shape], radius: str, output: Path
) -> Outcome:
    """Compare what the other half teaches with what the same half teaches, and with closings that learn nothing.

    Parameters
    ----------
    paper : Paper
    shapes : sequence of Shape
        To be cut in two, at least one.
    every : sequence of Shape
        What the patch length is chosen for, as in the experiment `dictionaries`.
    radius : str
        Of the holes, in mesh units.
    output : Path
        Folder for halves and repaired meshes.
    """
    scale = paper.learner.scale(every, radius)
    tables, data, rows = [], [], []
    for shape in shapes:
        cut = Halves.of(paper, shape, radius, output)
        methods = {
            TRANSFERRED: paper.learner.local(cut.learned_from, scale),
            "paper, same half": paper.learner.local(cut.case.shape, scale),
            "ours, other half": learn_ours(paper, cut.learned_from),
            "ours, punched half (`self`)": Method(SELF, SELF),
        }
        errors = {name: paper.error(cut.case, method) for name, method in methods.items()}
        errors |= {name: float(cut.case.peers[name]["error"]) for name in (MESHLAB, FAIR)}
        tables.append(_table(cut, errors))
        data.append({"mesh": shape.name, "radius": radius, "n_holes": len(cut.case.holes()), "errors": errors})
        rows += _drawn(paper, cut, methods[TRANSFERRED])
    plots: dict[str, Image.Image] = {"hole": compose(rows)} if rows else {}
    return Outcome("transfer", tables, {"rows": data}, plots)


def learn_ours(paper: Paper, shape: Shape) -> Method | None:
    """Learn a dictionary for the default recipe; None where the shape has fewer patches than such one has atoms."""
    label = f"ours-{shape.name}"
    key: Key = {"name": label, "sources_sha256": json.dumps({shape.name: shape.sha256})}
    folder = paper.learner.folder

    def learn() -> dict[str, Any]:
        try:
            learned = learn_dictionary([Source(shape.name, shape.truth, shape.sha256)], [], LearningOptions())
        except OptionError:  # fewer patches than atoms
            return {"file": None}
        folder.mkdir(parents=True, exist_ok=True)
        file = f"{label}_{shape.sha256[:10]}.safetensors"
        save_dictionary(folder / file, learned.dictionary, {"name": label, "use": "measuring only"})
        return {"file": file, "n_patches": learned.n_patches}

    file = paper.results.get(MODELS, key, learn)["file"]
    return Method(label, str(folder / file)) if file else None


def _table(cut: Halves, errors: Mapping[str, float | None]) -> Table:
    title = f"{cut.name}, second half, {len(cut.case.holes())} holes of radius {cut.case.radius}"
    body = [
        [name, scientific(error), figure(ratio(error, errors[FAIR])), figure(ratio(error, errors[MESHLAB]))]
        for name, error in errors.items()
    ]
    return Table(title, ["repair", "error, millionths", f"error / {FAIR}", f"error / {MESHLAB}"], body)


def _drawn(paper: Paper, cut: Halves, method: Method | None) -> list[Row]:
    """Draw the hole whose error by the transferred dictionary is the median of all."""
    closing = cut.case.folder / f"{MESHLAB}.ply"
    if method is None or not closing.is_file() or not repaired_path(cut.case, method).is_file():
        return []
    found = measure(paper.bench, cut.case, method, paper.results)["per_hole"]
    if not found:
        return []
    hole = sorted(found, key=lambda entry: float(entry["true_error"]))[len(found) // 2]
    repairs = {_CLOSING: closing, TRANSFERRED: repaired_path(cut.case, method)}
    tiles = DrawnCase.of(paper.bench, cut.case, repairs).tiles(np.array(hole["centre"]))
    caption = f"{cut.name}, second half, hole {hole['id']}: the median of all by the dictionary of the other half, "
    caption += f"error {percent_of_radius(cut.case, hole):.1f} % of the hole's radius"
    return [Row(caption, {name: tiles[name] for name in (PUNCHED, *repairs, TRUTH)})]
