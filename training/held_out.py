"""Meshes that are kept from learning, and what repairs of them say of the model that was learned from the others.

Of a single mesh, holes that are cut into it are kept instead. What can't be read is left out with a warning.

Tested in `tests/training/test_requested.py`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from quadpatch.errors import QuadpatchError, StageError
from quadpatch.model_choice import SMOOTH
from quadpatch.stages import Stages
from quadpatch_rules.coded_warnings import warning
from quadpatch_rules.training_verdict import Verdict, mean_ratio, verdict_of
from training.corpus import read_mesh
from training.judgement import KnownHoles, cut_known_holes, repair_error
from training.sources import Source

# Meshes that are judged: each is repaired twice.
MOST_JUDGED = 8


@dataclass(frozen=True)
class Split:
    """Meshes to learn from, and holes with known surface by the name of their mesh.

    `kept` is what of the latter was kept from learning: whole meshes, or the holes of a single one.
    """

    learn: list[Source]
    judge: dict[str, KnownHoles]
    held_out: list[Source]
    kept: Literal["mesh", "holes"]


@dataclass(frozen=True)
class Judgement:
    """Errors of a model and of the plain fill for each mesh that was judged, JSON-ready, and what they come to."""

    judged: list[dict[str, Any]]
    verdict: Verdict

    def facts(self) -> dict[str, Any]:
        """Return what the card of a model says of it; the model belongs to the one who asked for it."""
        ratios = [mesh["ratio"] for mesh in self.judged]
        metrics = {"meshes_judged": float(len(ratios))}
        if ratios:
            metrics["error_to_plain"] = round(mean_ratio(ratios), 4)
        return {"metrics": metrics, "licence": "", "verdict": self.verdict.text, "judged": self.judged}

    def report(self) -> dict[str, Any]:
        """Return what a report says of it."""
        return {"judged": self.judged, "verdict": self.verdict.text, "is_better": self.verdict.is_better}


def split_meshes(
    meshes: Sequence[Source], folder: Path, share_and_seed: tuple[float, int], stages: Stages, warnings: list[str]
) -> Split:
    """Choose which meshes are kept from learning, and cut holes into them.

    Parameters
    ----------
    meshes : sequence of Source
    folder : Path
        Holes are written there.
    share_and_seed : float, int
        Share of the meshes that are kept, and what starts the choice.
    stages : Stages
        Told how far it is.
    warnings : list of str
        Sentences are added.

    Raises
    ------
    StageError
        If no mesh can be read.
    """
    share, seed = share_and_seed
    readable = [source for source in meshes if _is_readable(source, warnings)]
    if not readable:
        raise StageError("none of the meshes can be read")
    rng = np.random.default_rng([seed, 4])
    n_held_out = min(max(1, round(share * len(readable))), MOST_JUDGED, max(len(readable) - 1, 1))
    chosen = set(rng.permutation(len(readable))[:n_held_out].tolist())
    judge: dict[str, KnownHoles] = {}
    for done, i in enumerate(sorted(chosen)):
        source = readable[i]
        holes = cut_known_holes(read_mesh(source.path), folder / f"punched-{i}.ply", rng)
        if holes is None:
            warnings.append(warning("mesh_without_room", mesh=source.name))
        else:
            judge[source.name] = holes
        stages.part(0.5, 1.0)((done + 1) / len(chosen))
    held_out = [readable[i] for i in sorted(chosen)]
    if len(readable) > 1:
        return Split([source for i, source in enumerate(readable) if i not in chosen], judge, held_out, "mesh")
    (only,) = readable
    path = judge[only.name].punched if judge else only.path
    return Split([Source(only.name, path, only.sha256)], judge, held_out, "holes")


def judge_model(split: Split, model: Path, seed: int, stages: Stages, warnings: list[str]) -> Judgement:
    """Repair every mesh that is judged, by the model and by the plain fill; lengths are in its units."""
    reach, judged = stages.part(0.0, 1.0), list[dict[str, Any]]()
    for done, (name, holes) in enumerate(split.judge.items()):
        try:
            plain, learned = (repair_error(holes, way, seed) for way in (SMOOTH, model))
        except QuadpatchError as error:
            warnings.append(warning("mesh_not_judged", mesh=name, mesh_code=error.code, reason=str(error)))
            continue
        # On a surface that is closed without any error both are equally good.
        ratio = learned / plain if plain > 0 and learned > 0 else 1.0
        figures = {"holes": len(holes.centres), "error": learned, "plain_error": plain, "ratio": ratio}
        judged.append({"mesh_id": name, "kept": split.kept, **figures})
        reach((done + 1) / len(split.judge))
    return Judgement(judged, verdict_of([mesh["ratio"] for mesh in judged]))


def _is_readable(source: Source, warnings: list[str]) -> bool:
    try:
        read_mesh(source.path)
    except QuadpatchError as error:
        warnings.append(warning("mesh_left_out", mesh=source.name, mesh_code=error.code, reason=str(error)))
        return False
    return True
