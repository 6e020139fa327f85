"""The paper's dictionaries: local (the undamaged mesh itself), global (all meshes), leave-one-out (all others).

They are learned from meshes that are for measuring only, so they stay in the output folder and are never published.
"""

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.quality.bench import Bench, BenchError, Shape
from benchmarks.quality.measurement import Method
from benchmarks.quality.results import CODINGS, MODELS, Key, Results
from quadpatch.inpainters.model_file import load_model, save_dictionary
from quadpatch.inpainters.paper_dictionary import GLOBAL_ATOMS, LOCAL_ATOMS, learn_heights
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.model_choice import SELF
from quadpatch.options import DictionaryOptions, PatchOptions
from quadpatch.patches.normalisation import HEIGHTS, raw_heights
from quadpatch.patches.paper_layout import learnable
from quadpatch.patches.scale import PatchScale
from quadpatch.recipes.paper import paper_scale
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.sparse.omp import masked_omp
from quadpatch.types import BoolArray, FloatArray

PAPER = "paper"
SEED = 0
MOST_CODED = 2000


@dataclass
class Learner:
    """Learns the paper's dictionaries, and keeps them."""

    bench: Bench
    results: Results
    folder: Path
    _cut: dict[tuple[str, PatchScale], tuple[FloatArray, BoolArray]] = field(default_factory=dict)

    def scale(self, shapes: Sequence[Shape], radius: str, hole_to_patch: float | None = None) -> PatchScale:
        """Choose one patch length for all shapes.

        That of the paper's recipe, for holes of the radius and the median of the shapes' mean edges; or that which
        makes the ratio of the holes' diameter to it, if one is given.
        """
        diameter = 2 * float(radius)
        length = None if hole_to_patch is None else diameter / hole_to_patch
        edges = [mean_edge_length(self.bench.read(shape.truth)) for shape in shapes] if length is None else [1.0]
        return paper_scale([diameter], float(np.median(edges)), PatchOptions(length=length))

    def local(self, shape: Shape, scale: PatchScale, n_atoms: int = LOCAL_ATOMS) -> Method | None:
        """Learn from the undamaged mesh itself; None where it has too few patches of this scale."""
        return self._method(f"local-{shape.name}", [shape], scale, n_atoms)

    def many(self, name: str, shapes: Sequence[Shape], scale: PatchScale, n_atoms: int = GLOBAL_ATOMS) -> Method | None:
        """Learn from many undamaged meshes; None where they have too few patches of this scale."""
        return self._method(name, shapes, scale, n_atoms)

    def self_similar(self, scale: PatchScale) -> Method:
        """Learn from the punched mesh, at the time of the repair."""
        return Method(f"paper-self_{scale.length:.4g}", SELF, _options(scale))

    def coding_error(self, shape: Shape, scale: PatchScale, method: Method) -> float:
        """Mean distance along z between the patches of an undamaged mesh and what their codes say, mesh units."""
        key = {"mesh": shape.name, "sha256": shape.sha256, **method.key()}

        def compute() -> dict[str, Any]:
            dictionary = load_model(method.model).dictionary
            if dictionary is None:
                raise BenchError(f"{method.model} is no dictionary")
            heights, known = self._patches(shape, scale)
            # More patches than this don't change the mean.
            sample = slice(None, None, -(-len(heights) // MOST_CODED) or 1)
            return {"error": _coding_error(heights[sample], known[sample], dictionary)}

        return float(self.results.get(CODINGS, key, compute)["error"])

    def _method(self, name: str, shapes: Sequence[Shape], scale: PatchScale, n_atoms: int) -> Method | None:
        label = f"paper-{name}_{n_atoms}_{scale.length:.4g}"
        sources = {shape.name: shape.sha256 for shape in shapes}
        key: Key = {"name": label, "sources_sha256": json.dumps(sources), "seed": SEED}
        model = self.results.get(MODELS, key, lambda: self._learn(label, key, shapes, (scale, n_atoms)))
        return Method(label, str(self.folder / model["file"]), _options(scale)) if model["file"] else None

    def _learn(self, label: str, key: Key, shapes: Sequence[Shape], size: tuple[PatchScale, int]) -> dict[str, Any]:
        scale, n_atoms = size
        cut = [self._patches(shape, scale) for shape in shapes]
        learned = learn_heights(
            np.concatenate([heights for heights, _ in cut]),
            np.concatenate([known for _, known in cut]),
            DictionaryOptions(n_atoms, None),
            np.random.default_rng(SEED),
        )
        if learned is None:
            return {"file": None}
        self.folder.mkdir(parents=True, exist_ok=True)
        # Many sets of shapes go by one label.
        file = f"{label}_{hashlib.sha256(json.dumps(dict(key)).encode()).hexdigest()[:10]}.safetensors"
        card = {"name": label, "learned_from": dict(key), "use": "measuring only, not for publication"}
        save_dictionary(self.folder / file, learned.dictionary, card, HEIGHTS)
        return {"file": file, "n_patches": sum(len(heights) for heights, _ in cut)}

    def _patches(self, shape: Shape, scale: PatchScale) -> tuple[FloatArray, BoolArray]:
        """Heights (n, N, N) and known bins of a whole mesh; those of one scale at a time are kept in memory."""
        cache_key = (shape.sha256, scale)
        if cache_key not in self._cut:
            self._cut = {key: cut for key, cut in self._cut.items() if key[1] == scale}
            patches = learnable(self.bench.patches(shape.truth, scale, SEED))
            self._cut[cache_key] = patches.heights, patches.known
        return self._cut[cache_key]


def _coding_error(heights: FloatArray, known: BoolArray, dictionary: Dictionary) -> float:
    """Mean absolute difference between known heights and what their codes make of them."""
    signals, _ = raw_heights(heights, known)
    flat = known.reshape(signals.shape)
    coded = masked_omp(signals, flat, dictionary.atoms, dictionary.n_nonzero) @ dictionary.atoms.T
    return float(np.abs(coded - heights.reshape(signals.shape))[flat].mean())


def _options(scale: PatchScale) -> dict[str, Any]:
    patches = {"length": scale.length, "resolution": scale.resolution, "overlap": scale.overlap}
    return {"recipe": PAPER, "patches": patches}
