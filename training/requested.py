"""A dictionary that the service was asked for: meshes in, a dictionary file with its card out, and a report.

Tested in `tests/training/test_requested.py`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quadpatch.inpainters.model_file import save_dictionary
from quadpatch.progress import Progress, no_progress
from quadpatch.report import describe_stages
from quadpatch.sparse.ksvd import KsvdOptions
from quadpatch.stages import Stages, harmless
from quadpatch_rules.coded_warnings import described
from training.card import dictionary_card
from training.corpus import PatchRecipe
from training.dictionary import Learned, LearningOptions, learn_dictionary
from training.held_out import judge_model, split_meshes
from training.sources import Source

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
        If no mesh can be read.
    OptionError
        If the meshes give fewer patches than atoms.
    """
    stages, warnings = Stages(harmless(progress)), list[str]()
    with stages.stage("read"):
        split = split_meshes(meshes, output.parent, (options.held_out, options.seed), stages, warnings)
    learning = options.learning(len(split.learn))
    learned = _learn(split.learn, learning, stages)
    save_dictionary(output, learned.dictionary, {"name": options.name})
    with stages.stage("judge"):
        judgement = judge_model(split, output, options.seed, stages, warnings)
    card = dictionary_card((options.name, None), learned, (split.learn, split.held_out), learning, COMMAND)
    with stages.stage("write"):
        save_dictionary(output, learned.dictionary, card | judgement.facts())
    return {
        "schema": 1,
        "task": "train",
        "kind": "dictionary",
        "stages": describe_stages(stages),
        "learned_from": [source.name for source in split.learn],
        "patches": learned.n_patches,
        "learning_errors": [round(float(error), 5) for error in learned.errors],
        **judgement.report(),
        **described(warnings),
    }


def _learn(sources: list[Source], learning: LearningOptions, stages: Stages) -> Learned:
    """Cut patches and learn; each of the two is about half of the work."""
    with stages.stage("learn"):
        cut, learn = stages.part(0.0, 0.5), stages.part(0.5, 1.0)
        n_iterations = learning.ksvd.n_iterations
        return learn_dictionary(
            sources, [], learning, lambda _, done: cut(done), lambda i, _: learn((i + 1) / n_iterations)
        )
