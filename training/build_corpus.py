"""Cutting the patches of meshes and of procedural reliefs into a corpus on disk.

For the recipe `paper` a patch is the array `heights`, float32: heights over the plane of the patch, in patch lengths, 0
in unknown bins; and the array `known`, bool. Not float16: its steps reach 1.2e-4 of the
patch length where relief is deepest, as much as the least relief that is worth learning (`LEAST_RELIEF`), and mapped
files need no memory that it would save. For the recipe `residual` see `training.training_pairs`.
"""

import hashlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from quadpatch.errors import OptionError
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.patches import residual_input
from quadpatch.patches.normalisation import HEIGHTS
from quadpatch.progress import Progress, no_progress
from quadpatch.types import TriangleMesh
from training import training_pairs
from training.corpus import PatchRecipe, cut_patches
from training.dictionary import HOLDOUT_SEED_OFFSET, PROCEDURAL_SEEDS
from training.normalise import read_normalised
from training.patterns import PATTERNS
from training.procedural import Relief, reliefs
from training.shards import Arrays, Corpus, CorpusWriter, Facts
from training.sources import Source

# As in the smallest patches of a repair by the paper's recipe, which are 24 bins of half an edge wide. Patches for the
# networks of 100 x 100 bins are as wide as those of 24 x 24: they show the same surface, more finely.
EDGES = 12.0
SCALES = (1.0, 1.5, 2.0, 3.0)
OWN_LICENCE = "GPL-3.0-or-later"


@dataclass(frozen=True)
class CorpusOptions:
    """What goes into a corpus.

    Attributes
    ----------
    recipe : str
        One of `CUTTERS`.
    resolution : int
        Bins along one side.
    edges : float
        Side of the smallest patches, in mean edges of the mesh.
    scales : tuple of float
        Patches are cut at each of these multiples.
    overlap : int
        k: besides its centre, every quad carries 4 k offset patches.
    places : int
        Of one mesh, for each scale, at most.
    n_procedural : int
        Procedural meshes of each pattern; with any, one of each pattern and of another seed joins the validation.
    relief_side : int
        Vertices along one side of a procedural mesh.
    seed : int
    edge_length : float or None
        Meshes are scaled into the unit cube and brought to this edge length first; None leaves them as they are.
    command : str
        What was typed, for the cards of the networks that learn from it.
    """

    recipe: str = "paper"
    resolution: int = 24
    edges: float = EDGES
    scales: tuple[float, ...] = SCALES
    overlap: int = 2
    places: int = 2000
    n_procedural: int = 0
    relief_side: int = 120
    seed: int = 0
    edge_length: float | None = None
    command: str = ""

    def __post_init__(self) -> None:
        """Refuse bins that no network of the recipe reads."""
        if self.recipe == "residual" and self.resolution != RESOLUTIONS["residual"]:
            raise OptionError(f"the recipe residual has {RESOLUTIONS['residual']} bins; got {self.resolution}")

    def facts(self) -> Facts:
        """Return what the manifest says about the patches."""
        return {
            "recipe": self.recipe,
            "resolution": self.resolution,
            "length_rule": training_pairs.LENGTH_RULE if self.recipe == "residual" else self._length_rule(),
            "overlap": self.overlap,
            "max_places_per_mesh_and_scale": self.places,
            "procedural": {"patterns": sorted(PATTERNS), "n_each": self.n_procedural} if self.n_procedural else {},
            **({"edge_length": self.edge_length} if self.edge_length is not None else {}),
            "seed": self.seed,
            "command": self.command,
        }

    def _length_rule(self) -> str:
        return f"{self.edges:g} mean edges, times {', '.join(f'{scale:g}' for scale in self.scales)}"


Cutter = Callable[[TriangleMesh, CorpusOptions, np.random.Generator], Arrays]


def build_corpus(
    sources: list[Source],
    holdout: list[Source],
    options: CorpusOptions,
    folder: Path,
    progress: Progress = no_progress,
) -> Corpus:
    """Cut patches and write them.

    Parameters
    ----------
    sources, holdout : list of Source
        Meshes to train on, and meshes to validate on.
    options : CorpusOptions
    folder : Path
        Empty, or made.
    progress : callable
        Told the name of each mesh before it is cut, and the share that is done.

    Raises
    ------
    OptionError
        If the folder is not empty.
    MeshError
        If a mesh can't be read.
    """
    writer = CorpusWriter(folder, options.facts())
    cut = CUTTERS[options.recipe]
    n_all = len(sources) + len(holdout) + (2 * len(PATTERNS) if options.n_procedural else 0)
    done = 0
    for split, meshes in (("train", sources), ("validation", holdout)):
        for source in meshes:
            progress(source.name, done / n_all)
            rng = np.random.default_rng([options.seed, 0, done])
            writer.add(source, split, cut(read_normalised(source.path, options.edge_length), options, rng))
            done += 1
    few = replace(options, places=min(options.places, PROCEDURAL_SEEDS))
    for split, n_each, seed in (
        ("train", options.n_procedural, options.seed),
        ("validation", min(options.n_procedural, 1), options.seed + HOLDOUT_SEED_OFFSET),
    ):
        for pattern, made in _by_pattern(reliefs(n_each, seed, options.relief_side)):
            progress(pattern, done / n_all)
            rng = np.random.default_rng([seed, 1, done])
            parts = [cut(relief.mesh, few, rng) for relief in made]
            joined = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
            writer.add(_relief_source(pattern, seed, made), split, joined)
            done += 1
    progress("", 1.0)
    return writer.finish()


def cut_heights(mesh: TriangleMesh, options: CorpusOptions, rng: np.random.Generator) -> Arrays:
    """Cut the patches that the paper's networks learn from: see the head of this module."""
    base = options.edges * mean_edge_length(mesh)
    recipe = PatchRecipe(options.resolution, base, options.scales, options.overlap, options.places, HEIGHTS)
    patches = cut_patches(mesh, recipe, rng)
    return {"heights": patches.detail.astype(np.float32), "known": patches.known}


def cut_training_pairs(mesh: TriangleMesh, options: CorpusOptions, rng: np.random.Generator) -> Arrays:
    """Cut the training pairs that the network `residual` learns from."""
    return training_pairs.cut_training_pairs(mesh, options.places, rng)


CUTTERS: dict[str, Cutter] = {"paper": cut_heights, "residual": cut_training_pairs}
# Bins along one side where nothing else is asked for.
RESOLUTIONS = {"paper": 24, "residual": residual_input.RESOLUTION}


def _by_pattern(made: Iterator[Relief]) -> Iterator[tuple[str, list[Relief]]]:
    """Group reliefs that follow each other, by pattern: one shard for each."""
    group: list[Relief] = []
    for relief in made:
        if group and relief.pattern != group[0].pattern:
            yield group[0].pattern, group
            group = []
        group.append(relief)
    if group:
        yield group[0].pattern, group


def _relief_source(pattern: str, seed: int, made: list[Relief]) -> Source:
    digest = hashlib.sha256()
    for relief in made:
        digest.update(relief.mesh.vertices.tobytes() + relief.mesh.triangles.tobytes())
    origin = f"{len(made)} procedural, seed {seed}"
    return Source(f"procedural_{pattern}", Path(), digest.hexdigest(), OWN_LICENCE, origin)
