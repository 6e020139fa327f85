"""From stages and fractions to one percentage that never falls."""

# Share of a typical repair's time, in percent; a stage that a method leaves out is jumped over.
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
        """Take note of a stage and its done fraction; a stage of an unknown name moves nothing."""
        self.stage = stage
        names = list(_SHARES)
        if stage in _SHARES:
            before = sum(_SHARES[name] for name in names[: names.index(stage)])
            reached = before + _SHARES[stage] * min(max(fraction, 0.0), 1.0)
            # 100 is for a published result alone.
            self.percent = max(self.percent, min(round(reached, 1), 99.0))
