"""Learning a dictionary: cut patches, learn atoms, measure them on meshes kept aside.

Everything random follows from one seed, so the same meshes and options give the same bytes (on the same kind of
processor and the same numpy: elsewhere matrix products may round differently).
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from quadpatch.errors import OptionError
from quadpatch.inpainters import paper_dictionary
from quadpatch.patches.normalisation import HEIGHTS, NORMALISATION, to_signals
from quadpatch.progress import Progress, no_progress
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.sparse.ksvd import KsvdOptions, OnIteration, masked_ksvd
from quadpatch.types import FloatArray
from quadpatch_rules.option_words import Recipe
from training.corpus import PatchRecipe, TrainingPatches, cut_patches, turn_at_random
from training.evaluation import evaluate
from training.normalise import read_normalised
from training.patterns import PATTERNS
from training.procedural import reliefs
from training.sources import Source

# Procedural reliefs to measure on come from seeds that no training run uses.
HOLDOUT_SEED_OFFSET = 1_000_000
# Places taken from one procedural relief: rather many reliefs than many views of the same one.
PROCEDURAL_SEEDS = 250


@dataclass(frozen=True)
class LearningOptions:
    """What to learn from, and how.

    Attributes
    ----------
    recipe : PatchRecipe
    ksvd : KsvdOptions
    n_procedural : int
        Procedural meshes of each pattern.
    relief_side : int
        Vertices along one side of a procedural mesh.
    seed : int
    edge_length : float or None
        Meshes are scaled into the unit cube and brought to this edge length first; None leaves them as they are.
    """

    recipe: PatchRecipe = field(default_factory=PatchRecipe)
    ksvd: KsvdOptions = field(default_factory=KsvdOptions)
    n_procedural: int = 0
    relief_side: int = 120
    seed: int = 0
    edge_length: float | None = None


# What is learned where nothing else is asked for, for each recipe of a repair.
USUAL: dict[Recipe, LearningOptions] = {
    "default": LearningOptions(),
    "paper": LearningOptions(
        PatchRecipe(scales=(1.0,), normalisation=HEIGHTS),
        KsvdOptions(paper_dictionary.GLOBAL_ATOMS, paper_dictionary.NONZERO),
    ),
}


@dataclass(frozen=True)
class Learned:
    """A dictionary, and how it came about.

    Attributes
    ----------
    dictionary : Dictionary
    errors : (n_iterations,) float64
        Root mean square error on the training signals after each iteration; 1 is their own root mean square.
    n_patches : int
        Training patches.
    metrics : dict
        On the meshes kept aside; empty without any.
    """

    dictionary: Dictionary
    errors: FloatArray
    n_patches: int
    metrics: dict[str, float]


def learn_dictionary(
    sources: list[Source],
    holdout: list[Source],
    options: LearningOptions,
    progress: Progress = no_progress,
    on_iteration: OnIteration | None = None,
) -> Learned:
    """Learn a dictionary from meshes and procedural reliefs.

    Parameters
    ----------
    sources : list of Source
        Meshes to learn from.
    holdout : list of Source
        Meshes to measure on; with `n_procedural`, one procedural relief of each pattern joins them.
    options : LearningOptions
    progress : callable
        Stages `training patches`, `held-out scans` and `held-out reliefs`.
    on_iteration : callable, optional
        Told the error after each iteration of K-SVD.

    Raises
    ------
    OptionError
        If the meshes give fewer patches than atoms.
    MeshError
        If a mesh can't be read.
    """
    ksvd = options.ksvd
    patches = _gather(sources, options, (options.n_procedural, options.seed), _named(progress, "training patches"))
    if len(patches) < ksvd.n_atoms:
        raise OptionError(
            f"the meshes give {len(patches)} patches, and {ksvd.n_atoms} atoms need at least as many: "
            "take fewer atoms, or more meshes"
        )
    patches = turn_at_random(patches, np.random.default_rng([options.seed, 1]))
    rng = np.random.default_rng([options.seed, 2])
    atoms, errors, n_patches = LEARNERS[options.recipe.normalisation](patches, ksvd, rng, on_iteration)
    dictionary = Dictionary(_in_file_precision(atoms), options.recipe.resolution, ksvd.n_nonzero)
    return Learned(dictionary, errors, n_patches, _measure(dictionary, holdout, options, progress))


# Atoms, errors by iteration, and how many patches took part.
Atoms = tuple[FloatArray, FloatArray, int]
Learner = Callable[[TrainingPatches, KsvdOptions, np.random.Generator, OnIteration | None], Atoms]


def _learn_detail(
    patches: TrainingPatches, ksvd: KsvdOptions, rng: np.random.Generator, on_iteration: OnIteration | None
) -> Atoms:
    """Learn the atoms of detail."""
    signals, _ = to_signals(patches.detail, patches.known)
    return *masked_ksvd(signals, patches.known.reshape(signals.shape), ksvd, rng, on_iteration), len(patches)


def _learn_heights(
    patches: TrainingPatches, ksvd: KsvdOptions, rng: np.random.Generator, on_iteration: OnIteration | None
) -> Atoms:
    """Learn the atoms of heights as a repair by the paper's recipe does from one mesh."""
    learned = paper_dictionary.learn_atoms(patches.detail, patches.known, ksvd, rng, on_iteration)
    if learned is None or learned.dictionary.n_atoms < ksvd.n_atoms:
        raise OptionError(f"too few of the patches show relief for {ksvd.n_atoms} atoms: take fewer, or more meshes")
    return learned.dictionary.atoms, learned.errors, learned.n_patches


# What learns from patches, by what model cards call their signals.
LEARNERS: dict[str, Learner] = {NORMALISATION: _learn_detail, HEIGHTS: _learn_heights}


def _measure(
    dictionary: Dictionary, holdout: list[Source], options: LearningOptions, progress: Progress
) -> dict[str, float]:
    """Measure on scans and on procedural reliefs apart: they are not alike, and reliefs would outnumber the scans."""
    seed, normalisation = options.seed + HOLDOUT_SEED_OFFSET, options.recipe.normalisation
    metrics: dict[str, float] = {}
    for kind, sources, n_procedural in (("scan", holdout, 0), ("relief", [], min(options.n_procedural, 1))):
        patches = _gather(sources, options, (n_procedural, seed), _named(progress, f"held-out {kind}s"))
        clean = patches.detail[patches.is_clean]
        if len(clean):
            metrics |= {f"{kind}_{key}": value for key, value in evaluate(dictionary, clean, normalisation).items()}
    return metrics


def _gather(
    sources: list[Source], options: LearningOptions, made: tuple[int, int], progress: Progress
) -> TrainingPatches:
    """Cut the patches of all meshes, in their order; `made` is how many of each procedural relief, and their seed."""
    n_procedural, seed = made
    recipe = options.recipe
    few = replace(recipe, max_seeds=min(recipe.max_seeds, PROCEDURAL_SEEDS))
    n_all = len(sources) + n_procedural * len(PATTERNS)
    cut: list[TrainingPatches] = []
    for source in sources:
        mesh = read_normalised(source.path, options.edge_length)
        cut.append(cut_patches(mesh, recipe, np.random.default_rng([seed, 0, len(cut)])))
        progress("", len(cut) / n_all)
    for relief in reliefs(n_procedural, seed, options.relief_side):
        cut.append(cut_patches(relief.mesh, few, np.random.default_rng([seed, 0, len(cut)])))
        progress("", len(cut) / n_all)
    return TrainingPatches.joined(cut, recipe.resolution)


def _named(progress: Progress, stage: str) -> Progress:
    return lambda _, fraction: progress(stage, fraction)


def _in_file_precision(atoms: FloatArray) -> FloatArray:
    """Round atoms as their file will, so that what is measured is what is published."""
    rounded = atoms.astype(np.float32).astype(np.float64)
    return np.asarray(rounded / np.linalg.norm(rounded, axis=0))
