"""Tables of the paper's networks: errors beside the dictionary's and the peers', and what the networks cost."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from benchmarks.quality.bench import Case
from benchmarks.quality.network_options import Protocol
from benchmarks.quality.paper_experiments import FAIR, MESHLAB
from benchmarks.quality.tables import NOTHING, Table, figure, geometric_mean, ratio, scientific

DICTIONARY = "dictionary"
# What a table must say of what the networks were trained on.
PROTOCOL_NOTES: dict[Protocol, str] = {
    "local": "local (training and test share the mesh)",
    "global": "global (all meshes, that of the test among them)",
    "leave-one-out": "leave-one-out (all meshes but that of the test)",
}


@dataclass(frozen=True)
class Finding:
    """What was found for one mesh.

    Attributes
    ----------
    case : Case
    errors : dict of str to float or None
        By network, dictionary and peer; None where there was too little to learn from.
    networks : dict of str to dict
        Facts of each network that was trained: those of `TrainedNetwork`, `resolution`, and `complete_s` for
        `n_completed` patches of the repair.
    """

    case: Case
    errors: dict[str, float | None] = field(default_factory=dict)
    networks: dict[str, dict[str, Any]] = field(default_factory=dict)

    def to_fair(self, name: str) -> float | None:
        """Error over that of `fair`."""
        return ratio(self.errors[name], self.errors[FAIR])


def network_tables(protocol: Protocol, findings: Sequence[Finding]) -> list[Table]:
    """Tabulate what was found for several meshes at one radius."""
    subtitle = f"hole radius {findings[0].case.radius}, {PROTOCOL_NOTES[protocol]}"
    return [_ratios(subtitle, findings), _errors(subtitle, findings), _costs(subtitle, findings)]


def mean_to_fair(findings: Sequence[Finding], name: str) -> float | None:
    """Geometric mean over the meshes; None with a gap."""
    return geometric_mean(finding.to_fair(name) for finding in findings)


def _ratios(subtitle: str, findings: Sequence[Finding]) -> Table:
    names = [name for name in findings[0].errors if name != FAIR]
    body = [[f.case.shape.name, *(figure(f.to_fair(name)) for name in names)] for f in findings]
    means = ["geometric mean", *(figure(mean_to_fair(findings, name)) for name in names)]
    to_dictionary = [geometric_mean(ratio(f.errors[name], f.errors[DICTIONARY]) for f in findings) for name in names]
    other = [f"to the {DICTIONARY}", *(figure(value) for value in to_dictionary)]
    return Table(f"error / {FAIR}, {subtitle}", ["mesh", *names], [*body, means, other], 2)


def _errors(subtitle: str, findings: Sequence[Finding]) -> Table:
    names = list(findings[0].errors)
    body = [[f.case.shape.name, *(scientific(f.errors[name]) for name in names)] for f in findings]
    return Table(f"error, millionths of the object's size, {subtitle}", ["mesh", *names], body)


def _costs(subtitle: str, findings: Sequence[Finding]) -> Table:
    """Means over the meshes: what each network is, what its training took and what it takes to use."""
    names = [name for name in findings[0].errors if name not in (DICTIONARY, MESHLAB, FAIR)]
    columns = ["network", "bins", "parameters", "patches", "steps", "held-out loss"]
    columns += ["training s", "of them CPU s", "completion s", "ms a patch"]
    rows = [_cost(name, [f.networks[name] for f in findings if name in f.networks]) for name in names]
    return Table(f"networks (for measuring only), means over the meshes, {subtitle}", columns, rows)


def _cost(name: str, facts: Sequence[dict[str, Any]]) -> list[str]:
    if not facts:
        return [name, *[NOTHING] * 9]

    def mean(key: str) -> float:
        return float(np.mean([fact[key] for fact in facts]))

    n_bins = facts[0]["resolution"]
    counts = [f"{facts[0]['n_parameters']:,}", f"{mean('n_patches'):.0f}", f"{mean('steps'):.0f}"]
    times = [f"{mean(key):.0f}" for key in ("train_s", "train_cpu_s", "complete_s")]
    each = 1e3 * mean("complete_s") / max(mean("n_completed"), 1.0)
    return [name, f"{n_bins} x {n_bins}", *counts, f"{mean('validation_loss'):.5f}", *times, f"{each:.1f}"]
