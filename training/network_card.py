"""The card of a network, and the words of its page."""

from typing import Any

from quadpatch_rules.dictionary_file import Card
from training.architectures import Architecture
from training.card import PageWording
from training.checkpoint import TrainingState
from training.shards import Corpus
from training.trainer import TrainOptions

INTENDED_USE = (
    "Completing height-map patches of scanned surfaces inside holes, as Quadpatch does it with the recipe that the "
    "card names. It invents plausible relief; it does not measure. Not for patches normalised in another way, and not "
    "as evidence of what a damaged object looked like."
)

_REPEATING = (
    "Paths are shortened to their last part; the meshes are those listed below. The same commands come to the same",
    "quality; bit for bit they repeat only on the same kind of processor, with as many threads and the same torch.",
)
_PAPER = PageWording(
    "autoencoder",
    _REPEATING,
    (
        "Held-out scans (`scan_`) and procedural reliefs from another seed (`relief_`). A disk in the middle of each",
        "patch is hidden (its width in percent of the patch's side stands in the name) and completed by this file.",
        "`error`: root mean square error in the disk, in patch lengths; `to_plate`, `to_membrane`: divided by that of",
        "a thin plate or a membrane over the same hole. Below 1 the network is the better one. One patch at a time,",
        "cut from the undamaged mesh: these figures rank networks, they do not foretell the error of a repair.",
        "`validation_loss`: what training minimised, over random holes in the same held-out patches.",
    ),
)
_RESIDUAL = PageWording(
    "autoencoder",
    _REPEATING,
    (
        "Holes cut into held-out scans (`scan_`) and procedural reliefs from another seed (`relief_`), filled as a",
        "repair fills them. `to_fill`: mean absolute error of the corrected fill in the invented bins of patches,",
        "divided by that of the fill itself; 1 is a network that leaves every fill as it is. A network fitted to the",
        "mesh at hand (model `self-network`) starts from this one. `validation_loss`: what training minimised.",
    ),
)
# By recipe.
WORDINGS = {"paper": _PAPER, "residual": _RESIDUAL}


def network_card(
    name: tuple[str, int | None],
    architecture: Architecture,
    corpus: Corpus,
    options: TrainOptions,
    state: TrainingState,
    facts: dict[str, Any],
) -> Card:
    """Gather what there is to say about a network.

    Parameters
    ----------
    name : str, int or None
        And version, if it is to have a certain one.
    architecture : Architecture
    corpus : Corpus
    options : TrainOptions
    state : TrainingState
        When training ended.
    facts : dict
        What else belongs into the card: `command`, `metrics`, what the task says of its patches.

    Returns
    -------
    dict
        JSON-ready; says nothing of when and where.
    """
    meshes = {split: corpus.meshes(split) for split in ("train", "validation")}
    counts = {split: sum(mesh["count"] for mesh in meshes[split]) for split in meshes}
    scans = {split: [_source(mesh) for mesh in meshes[split] if not _is_relief(mesh)] for split in meshes}
    n = architecture.resolution
    procedural = dict(corpus.facts["procedural"])
    return {
        "name": name[0],
        "version": name[1],
        "description": (
            f"The network {architecture.name} on patches of {n} x {n} bins, trained on {counts['train']} patches of "
            f"{len(scans['train'])} meshes and {procedural.get('n_each', 0) * len(procedural.get('patterns', []))} "
            "procedural reliefs."
        ),
        "architecture": architecture.name,
        "patch_resolution": n,
        "recipe": architecture.recipe,
        "length_rule": "auto",
        "training": {
            "training_patch_length": corpus.facts["length_rule"],
            "n_patches": counts["train"],
            "n_validation_patches": counts["validation"],
            "steps": state.step,
            "batch": options.batch,
            "rate": options.rate,
            "weight_decay": options.weight_decay,
            "validation_losses": [[step, round(loss, 7)] for step, loss in state.validation],
        },
        "training_corpus": scans["train"],
        "procedural": {**procedural, "seed": corpus.facts["seed"]} if procedural else {},
        "held_out": scans["validation"],
        "corpus_sha256": corpus.sha256,
        "licence": "GPL-3.0-or-later",
        "intended_use": INTENDED_USE,
        "seed": options.seed,
        **facts,
    }


def _is_relief(mesh: dict[str, Any]) -> bool:
    return str(mesh["name"]).startswith("procedural_")


def _source(mesh: dict[str, Any]) -> dict[str, str]:
    return {key: str(mesh[key]) for key in ("name", "sha256", "licence", "origin")}
