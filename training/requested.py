"""A training that the service was asked for: meshes in, a dictionary file with its card out, and a report.

Some meshes are kept from learning and judged on; of a single mesh, holes that are cut into it. What can't be read is
left out with a warning.

Tested in `tests/training/test_requested.py`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from quadpatch.errors import QuadpatchError, StageError
from quadpatch.inpainters.model_file import save_dictionary
from quadpatch.model_choice import SMOOTH
from quadpatch.progress import Progress, no_progress
from quadpatch.report import describe_stages
from quadpatch.sparse.ksvd import KsvdOptions
from quadpatch.stages import Stages, harmless
from quadpatch_rules.training_verdict import Verdict, mean_ratio, verdict_of
from training.card import dictionary_card
from training.corpus import PatchRecipe, read_mesh
from training.dictionary import Learned, LearningOptions, learn_dictionary
from training.judgement import KnownHoles, cut_known_holes, repair_error
from training.sources import Source

# Meshes that are judged: each is repaired twice.
MOST_JUDGED = 8
# Values of all training patches together: what bounds memory and time, however many meshes there are.
MOST_VALUES = 7_000_000
COMMAND = "POST /v1/trainings"


@dataclass(frozen=True)
class TrainingOptions:
    """What to learn.

    Attributes
    ----------
    name : str
        Of the model.
    atoms, patch_resolution, steps : int
        Size of the dictionary, bins along one side of a patch, rounds of K-SVD.
    held_out : float
        Share of the meshes that are kept from learning.
    seed : int
    """

    name: str
    atoms: int = 256
    patch_resolution: int = 24
    steps: int = 15
    held_out: float = 0.25
    seed: int = 0

    def learning(self, n_meshes: int) -> LearningOptions:
        """Return the options of learning from so many meshes."""
        usual = PatchRecipe(self.patch_resolution)
        values = n_meshes * len(usual.scales) * self.patch_resolution**2
        recipe = PatchRecipe(self.patch_resolution, max_seeds=max(1, min(usual.max_seeds, MOST_VALUES // values)))
        ksvd = KsvdOptions(self.atoms, min(KsvdOptions.n_nonzero, self.atoms), self.steps)
        return LearningOptions(recipe, ksvd, seed=self.seed)


@dataclass(frozen=True)
class _Split:
    """Meshes to learn from, and holes with known surface by the name of their mesh.

    `kept` is what of the latter was kept from learning: whole meshes, or the holes of a single one.
    """

    learn: list[Source]
    judge: dict[str, KnownHoles]
    held_out: list[Source]
    kept: Literal["mesh", "holes"]


def train_dictionary(
    meshes: Sequence[Source], output: Path, options: TrainingOptions, progress: Progress = no_progress
) -> dict[str, Any]:
    """Learn a dictionary, judge it, and write it with its card.

    Parameters
    ----------
    meshes : sequence of Source
        Named by their ids.
    output : Path
        `.safetensors`; holes are written beside it.
    options : TrainingOptions
    progress : callable
        Stages `read`, `learn`, `judge` and `write`.

    Returns
    -------
    dict
        The report, JSON-ready.

    Raises
    ------
    StageError
        If no mesh can be read, or they give fewer patches than atoms.
    """
    stages, warnings = Stages(harmless(progress)), list[str]()
    with stages.stage("read"):
        split = _split(meshes, output.parent, options, stages, warnings)
    learning = options.learning(len(split.learn))
    learned = _learn(split.learn, learning, stages)
    save_dictionary(output, learned.dictionary, {"name": options.name})
    with stages.stage("judge"):
        judged = _judge(split, output, options, stages, warnings)
    verdict = verdict_of([mesh["ratio"] for mesh in judged])
    with stages.stage("write"):
        save_dictionary(output, learned.dictionary, _card(learned, split, learning, options, (judged, verdict)))
    return {
        "schema": 1,
        "task": "train",
        "stages": describe_stages(stages),
        "learned_from": [source.name for source in split.learn],
        "patches": learned.n_patches,
        "learning_errors": [round(float(error), 5) for error in learned.errors],
        "judged": judged,
        "verdict": verdict.text,
        "is_better": verdict.is_better,
        "warnings": warnings,
    }


def _split(
    meshes: Sequence[Source], folder: Path, options: TrainingOptions, stages: Stages, warnings: list[str]
) -> _Split:
    """Choose by the seed which meshes are kept from learning."""
    readable = [source for source in meshes if _is_readable(source, warnings)]
    if not readable:
        raise StageError("none of the meshes can be read")
    rng = np.random.default_rng([options.seed, 4])
    n_held_out = min(max(1, round(options.held_out * len(readable))), MOST_JUDGED, max(len(readable) - 1, 1))
    chosen = set(rng.permutation(len(readable))[:n_held_out].tolist())
    judge: dict[str, KnownHoles] = {}
    for done, i in enumerate(sorted(chosen)):
        source = readable[i]
        holes = cut_known_holes(read_mesh(source.path), folder / f"punched-{i}.ply", rng)
        if holes is None:
            warnings.append(f"mesh {source.name} has no room for holes to judge by")
        else:
            judge[source.name] = holes
        stages.part(0.5, 1.0)((done + 1) / len(chosen))
    held_out = [readable[i] for i in sorted(chosen)]
    if len(readable) > 1:
        return _Split([source for i, source in enumerate(readable) if i not in chosen], judge, held_out, "mesh")
    (only,) = readable
    path = judge[only.name].punched if judge else only.path
    return _Split([Source(only.name, path, only.sha256)], judge, held_out, "holes")


def _is_readable(source: Source, warnings: list[str]) -> bool:
    try:
        read_mesh(source.path)
    except QuadpatchError as error:
        warnings.append(f"mesh {source.name} is left out ({error.code}): {error}")
        return False
    return True


def _learn(sources: list[Source], learning: LearningOptions, stages: Stages) -> Learned:
    """Cut patches and learn; each of the two is about half of the work."""
    with stages.stage("learn"):
        cut, learn = stages.part(0.0, 0.5), stages.part(0.5, 1.0)
        n_iterations = learning.ksvd.n_iterations
        return learn_dictionary(
            sources, [], learning, lambda _, done: cut(done), lambda i, _: learn((i + 1) / n_iterations)
        )


def _judge(
    split: _Split, model: Path, options: TrainingOptions, stages: Stages, warnings: list[str]
) -> list[dict[str, Any]]:
    """Repair every mesh that is judged, by the model and by the plain fill; lengths are in its units."""
    reach, judged = stages.part(0.0, 1.0), list[dict[str, Any]]()
    for done, (name, holes) in enumerate(split.judge.items()):
        try:
            plain, learned = (repair_error(holes, way, options.seed) for way in (SMOOTH, model))
        except QuadpatchError as error:
            warnings.append(f"mesh {name} can't be judged ({error.code}): {error}")
            continue
        # On a surface that is closed without any error both are equally good.
        ratio = learned / plain if plain > 0 and learned > 0 else 1.0
        figures = {"holes": len(holes.centres), "error": learned, "plain_error": plain, "ratio": ratio}
        judged.append({"mesh_id": name, "kept": split.kept, **figures})
        reach((done + 1) / len(split.judge))
    return judged


def _card(
    learned: Learned,
    split: _Split,
    learning: LearningOptions,
    options: TrainingOptions,
    found: tuple[list[dict[str, Any]], Verdict],
) -> Mapping[str, Any]:
    """Gather what there is to say; meshes are named by their ids."""
    judged, verdict = found
    card = dictionary_card((options.name, None), learned, (split.learn, split.held_out), learning, COMMAND)
    ratios = [mesh["ratio"] for mesh in judged]
    metrics = {"meshes_judged": float(len(ratios))}
    if ratios:
        metrics["error_to_plain"] = round(mean_ratio(ratios), 4)
    facts = {"metrics": metrics, "licence": "", "verdict": verdict.text, "judged": judged}
    return card | facts
