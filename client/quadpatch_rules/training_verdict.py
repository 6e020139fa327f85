"""Whether a learned model does better than the plain fill, from the errors of both on meshes kept from learning."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

# Errors that differ by less than this share are the same.
SAME = 0.01


@dataclass(frozen=True)
class Verdict:
    """What held-out meshes say about a model.

    Attributes
    ----------
    text : str
        For people, such as `worse than the plain fill on 3 of 4 meshes`.
    is_better : bool
        Whether it is better on more meshes than it is worse on, and on the average of all.
    """

    text: str
    is_better: bool


def verdict_of(ratios: Sequence[float]) -> Verdict:
    """Judge a model.

    Parameters
    ----------
    ratios : sequence of float
        Error of the model divided by that of the plain fill, both above 0, for each mesh.
    """
    if not ratios:
        return Verdict("not judged: no mesh has room for a hole whose surface is known", is_better=False)
    n_better, n_worse = sum(ratio < 1 - SAME for ratio in ratios), sum(ratio > 1 + SAME for ratio in ratios)
    is_better = n_better > n_worse and mean_ratio(ratios) < 1
    if is_better:
        word, count = "better", n_better
    elif n_worse:
        word, count = "worse", n_worse
    else:
        word, count = "no better", len(ratios) - n_better
    noun = "mesh" if len(ratios) == 1 else "meshes"
    text = f"{word} than the plain fill on {count} of {len(ratios)} {noun}"
    if not is_better and n_better > n_worse:
        text += ", and by more than it is better on the others"
    return Verdict(text, is_better)


def mean_ratio(ratios: Sequence[float]) -> float:
    """Return the geometric mean of ratios, at least one."""
    return math.exp(sum(map(math.log, ratios)) / len(ratios))
