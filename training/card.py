"""Model cards: the facts inside a model file, and the page beside it.

Tested in `tests/training/test_main.py`.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quadpatch.patches.normalisation import HEIGHTS, NORMALISATION
from quadpatch.patches.scale import PRESETS
from quadpatch_rules.dictionary_file import Card
from training.dictionary import Learned, LearningOptions
from training.patterns import PATTERNS
from training.sources import Source, corpus_sha256

INTENDED_USE = (
    "Completing height-map patches of scanned surfaces inside holes, as Quadpatch does it. It "
    "invents plausible relief; it does not measure. Not for patches normalised in another way, and not as evidence of "
    "what a damaged object looked like."
)

_SIGNALS = {
    NORMALISATION: "heights over the base surface (smoothed as patches are wide), mean removed, over their deviation",
    HEIGHTS: "heights over the plane of the patch, in its lengths: the paper's own recipe",
}


@dataclass(frozen=True)
class PageWording:
    """What the page of a kind of model says besides the facts of its card.

    Attributes
    ----------
    kind : str
    repeating : tuple of str
        Lines on what the same command gives.
    measuring : tuple of str
        Lines on what the metrics mean.
    """

    kind: str
    repeating: tuple[str, ...]
    measuring: tuple[str, ...]


WORDING = PageWording(
    "dictionary",
    (
        "Paths are shortened to their last part; the meshes are those listed below. The same meshes and the same "
        "command",
        "give the same bytes, with the same numpy on the same kind of processor: elsewhere sums may round differently.",
    ),
    (
        "Patches of these scans (`scan_`) and of procedural reliefs from another seed (`relief_`), none of them",
        "learned from. A disk in the middle of each patch is hidden (its width in percent of the patch's side stands",
        "in the name) and completed. `error`: root mean square error in the disk, in the patch's own deviation;",
        "`to_plate`, `to_membrane`: divided by that of a thin plate or a membrane over the same hole; `to_unhidden`:",
        "divided by that of coding the whole patch. Below 1 the dictionary is the better one. One patch at a time,",
        "over the base surface of the undamaged mesh: these figures rank dictionaries; they are not the error of",
        "a repair.",
    ),
)


def dictionary_card(
    name: tuple[str, int | None],
    learned: Learned,
    sources: tuple[list[Source], list[Source]],
    options: LearningOptions,
    command: str,
) -> Card:
    """Gather what there is to say about a dictionary.

    Parameters
    ----------
    name : str, int or None
        And version, if it is to have a certain one.
    learned : Learned
    sources : list of Source, list of Source
        Meshes learned from, and meshes measured on.
    options : LearningOptions
    command : str
        What was typed, without folders.

    Returns
    -------
    dict
        JSON-ready; the same for the same bytes of input, wherever they lie.
    """
    trained_on, held_out = sources
    recipe, ksvd = options.recipe, options.ksvd
    procedural = {"patterns": sorted(PATTERNS), "n_each": options.n_procedural, "seed": options.seed}
    scales = ", ".join(f"{scale:g}" for scale in recipe.scales)
    share = PRESETS[recipe.preset][0] if recipe.preset else None
    base = f"{recipe.length:g} mesh units" if recipe.length else "as wide as a repair's own, by mean edge length"
    base = f"{share:g} of the longest side" if share else base
    parts = [f"{source.sha256} {source.name}" for source in trained_on]
    return {
        "name": name[0],
        "version": name[1],
        "description": (
            f"{ksvd.n_atoms} atoms of {recipe.resolution} x {recipe.resolution} bins, learned by K-SVD from "
            f"{learned.n_patches} patches of {len(trained_on)} meshes and "
            f"{options.n_procedural * len(PATTERNS)} procedural reliefs."
        ),
        "length_rule": base if share else "auto",
        **({"length_share": share} if share else {}),
        "recipe": {
            "signal": _SIGNALS[recipe.normalisation],
            "training_patch_length": f"patches {base}; times {scales}",
            **({"edge_length": f"{options.edge_length:g} of the longest side"} if options.edge_length else {}),
            "n_iterations": ksvd.n_iterations,
            "overlap": recipe.overlap,
            "max_places_per_mesh": recipe.max_seeds,
            "n_patches": learned.n_patches,
            "rms_error_by_iteration": [round(float(error), 5) for error in learned.errors],
        },
        "training_corpus": [source.facts() for source in trained_on],
        "procedural": procedural if options.n_procedural else {},
        "held_out": [source.facts() for source in held_out],
        "corpus_sha256": corpus_sha256([*parts, f"procedural {options.n_procedural} seed {options.seed}"]),
        "metrics": learned.metrics,
        "licence": "GPL-3.0-or-later",
        "intended_use": INTENDED_USE,
        "command": command,
        "seed": options.seed,
    }


def write_card_page(path: Path, card: Card, sha256: str, wording: PageWording = WORDING) -> None:
    """Write the card as a Markdown page."""
    path.write_text(_page(card, sha256, wording), "utf-8")


def _page(card: Card, sha256: str, wording: PageWording) -> str:
    version = f"@{card['version']}" if card["version"] else ""
    lines = [f"# {card['name']}{version}", "", str(card["description"]), ""]
    lines += ["| | |", "| --- | --- |"]
    lines += [f"| {key} | {value} |" for key, value in _facts(card, sha256, wording.kind).items()]
    lines += ["", "## Intended use", "", str(card["intended_use"])]
    lines += ["", "## How it was made", "", "```", str(card["command"]), "```", "", *wording.repeating, ""]
    made_so = card.get("training") or card["recipe"]
    lines += [f"- {key.replace('_', ' ')}: {value}" for key, value in made_so.items()]
    lines += ["", "## Learned from", "", *_mesh_table(card["training_corpus"])]
    if card["procedural"]:
        made = card["procedural"]
        lines += ["", f"And {made['n_each']} of each procedural relief, seed {made['seed']}: "]
        lines[-1] += ", ".join(made["patterns"]) + "."
    if card["metrics"]:
        lines += ["", "## Measured on", "", *_mesh_table(card["held_out"]), "", *wording.measuring]
        lines += ["", "| measure | value |", "| --- | --- |"]
        lines += [f"| {key} | {value:g} |" for key, value in card["metrics"].items()]
    return "\n".join(lines) + "\n"


def _facts(card: Card, sha256: str, kind: str) -> dict[str, Any]:
    return {
        "kind": kind,
        "licence": card["licence"],
        "seed": card["seed"],
        "corpus sha256": f"`{card['corpus_sha256']}`",
        "file sha256": f"`{sha256}`",
    }


def _mesh_table(meshes: list[dict[str, str]]) -> list[str]:
    rows = [f"| {m['name']} | {m['origin']} | {m['licence']} | `{m['sha256'][:12]}` |" for m in meshes]
    return ["| mesh | origin | licence and attribution | sha256 |", "| --- | --- | --- | --- |", *rows]
