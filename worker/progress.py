"""From stages and fractions to one percentage that never falls."""

# Share of a typical repair's time, in percent; a stage that a method leaves out is skipped.
_SHARES = {
    "read": 4,
    "holes": 2,
    "fill": 10,
    "smooth": 3,
    "quadrangulate": 10,
    "patchify": 12,
    "learn": 22,
    "inpaint": 15,
    "reconstruct": 8,
    "judge": 4,
    "write": 4,
    "preview": 2,
    "closeups": 3,
}


class Progress:
    """The furthest point that an attempt has reached."""

    def __init__(self) -> None:
        self.stage = ""
        self.percent = 0.0

    def reach(self, stage: str, fraction: float) -> None:
        """Record a stage and its done fraction; a stage of an unknown name changes no percentage."""
        self.stage = stage
        names = list(_SHARES)
        if stage in _SHARES:
            earlier_share = sum(_SHARES[name] for name in names[: names.index(stage)])
            percent = earlier_share + _SHARES[stage] * min(max(fraction, 0.0), 1.0)
            # Only a published result has 100.
            self.percent = max(self.percent, min(round(percent, 1), 99.0))
