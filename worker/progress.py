"""From stages and fractions to one percentage that never falls."""

from collections.abc import Mapping

from shared_rules.tasks import FILL, Task

# Share of a typical job's time, in percent. A repair by geometry alone is one long stage, `fill`.
_BY_GEOMETRY: Mapping[str, int] = {
    "read": 6,
    "holes": 4,
    "fill": 76,
    "judge": 4,
    "write": 4,
    "preview": 3,
    "closeups": 3,
}
_SHARES: Mapping[Task, Mapping[str, int]] = {
    "fill": {
        "read": 3,
        "holes": 2,
        "fill": 44,
        "smooth": 3,
        "quadrangulate": 7,
        "patchify": 8,
        "learn": 15,
        "inpaint": 5,
        "reconstruct": 3,
        "judge": 3,
        "write": 2,
        "preview": 2,
        "closeups": 3,
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
        "preview": 3,
    },
    "denoise": {
        "read": 2,
        "smooth": 60,
        "quadrangulate": 12,
        "learn": 3,
        "reconstruct": 16,
        "judge": 2,
        "write": 2,
        "preview": 3,
    },
    "encode": {
        "read": 4,
        "quadrangulate": 20,
        "learn": 25,
        "reconstruct": 30,
        "judge": 12,
        "write": 4,
        "preview": 5,
    },
    "decode": {"read": 30, "reconstruct": 50, "write": 15, "preview": 5},
}
_MOST = 99.0


class Progress:
    """The furthest point that an attempt at a task has reached; whether geometry alone fills says how long it takes."""

    def __init__(self, task: Task = FILL, *, by_geometry: bool = False) -> None:
        self._shares = _BY_GEOMETRY if by_geometry and task == FILL else _SHARES[task]
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
