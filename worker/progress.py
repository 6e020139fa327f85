"""From stages and fractions to one percentage that never falls."""

from collections.abc import Mapping
from typing import Literal

from quadpatch_rules.tasks import FILL, Task

# What holes are filled by, as far as the time goes: a model that is ready or learned in seconds, or one that is fitted.
FilledBy = Literal["geometry", "model", "fitting"]

# Share of a typical job's time, in percent. A repair by geometry alone is one long stage, `fill`; a network that is
# fitted to the mesh takes longer than all the rest.
_OTHER_FILLS: Mapping[str, Mapping[str, int]] = {
    "geometry": {
        "read": 6,
        "holes": 4,
        "fill": 70,
        "judge": 4,
        "colour": 6,
        "write": 4,
        "preview": 2,
        "closeups": 2,
        "html_report": 2,
    },
    "fitting": {
        "read": 1,
        "holes": 1,
        "fill": 15,
        "smooth": 2,
        "quadrangulate": 1,
        "patchify": 7,
        "learn": 59,
        "inpaint": 2,
        "reconstruct": 2,
        "judge": 2,
        "colour": 2,
        "write": 1,
        "preview": 1,
        "closeups": 2,
        "html_report": 2,
    },
}
_SHARES: Mapping[Task, Mapping[str, int]] = {
    "fill": {
        "read": 3,
        "holes": 2,
        "fill": 39,
        "smooth": 3,
        "quadrangulate": 7,
        "patchify": 8,
        "learn": 15,
        "inpaint": 5,
        "reconstruct": 3,
        "judge": 3,
        "colour": 3,
        "write": 2,
        "preview": 2,
        "closeups": 3,
        "html_report": 2,
    },
    # The first of two stages named `judge` says which placement is taken.
    "restore": {
        "read": 2,
        "fill": 40,
        "judge": 3,
        "smooth": 2,
        "quadrangulate": 4,
        "patchify": 26,
        "learn": 3,
        "inpaint": 13,
        "reconstruct": 2,
        "write": 2,
        "preview": 2,
        "html_report": 1,
    },
    "denoise": {
        "read": 2,
        "smooth": 60,
        "quadrangulate": 12,
        "learn": 3,
        "reconstruct": 16,
        "judge": 2,
        "write": 2,
        "preview": 2,
        "html_report": 1,
    },
    "encode": {
        "read": 4,
        "quadrangulate": 20,
        "learn": 25,
        "reconstruct": 30,
        "judge": 12,
        "write": 4,
        "preview": 3,
        "html_report": 2,
    },
    "decode": {"read": 30, "reconstruct": 50, "write": 13, "preview": 4, "html_report": 3},
    "train": {"read": 8, "learn": 55, "judge": 35, "write": 2},
}
_MOST = 99.0


class Progress:
    """The furthest point that an attempt at a task has reached; what fills holes says how long each stage takes."""

    def __init__(self, task: Task = FILL, filled_by: FilledBy = "model") -> None:
        self._shares = _OTHER_FILLS.get(filled_by, _SHARES[FILL]) if task == FILL else _SHARES[task]
        self.stage = ""
        self.percent = 0.0

    def reach(self, stage: str, fraction: float) -> None:
        """Record a stage and its done fraction; a stage of an unknown name changes no percentage."""
        self.stage = stage
        names = list(self._shares)
        if stage in self._shares:
            earlier_share = sum(self._shares[name] for name in names[: names.index(stage)])
            percent = earlier_share + self._shares[stage] * min(max(fraction, 0.0), 1.0)
            # Only a published result has 100.
            self.percent = max(self.percent, min(round(percent, 1), _MOST))
