"""The order of the paper's networks: equal data, batch and steps, a learning rate found for each, several seeds.

Every network is trained on the patches of the undamaged mesh (training and test share the mesh, as in the paper's own
local experiment), with the same count of patches in a step and the same count of steps. The rate is the one of a few
whose short run has the least held-out loss. What comes out is the held-out loss, in nats a bin, and the error of the
repair by each seed.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.quality.bench import Case
from benchmarks.quality.network_experiment import Networks
from benchmarks.quality.network_options import Budget, Order, Pace
from benchmarks.quality.outcome import Outcome
from benchmarks.quality.paper_experiments import FAIR
from benchmarks.quality.paper_networks import TrainedNetwork
from benchmarks.quality.tables import Table, figure
from training.architectures import Architecture


@dataclass(frozen=True)
class Entry:
    """One network on one mesh.

    Attributes
    ----------
    name : str
    rate : float
        The one found.
    losses, ratios : list of float
        Held-out loss, and error over that of `fair`, by seed.
    """

    name: str
    rate: float
    losses: list[float]
    ratios: list[float]


def network_order_experiment(networks: Networks, cases: Sequence[Case], order: Order) -> Outcome:
    """Train every network on every mesh by equal terms and rank them.

    Parameters
    ----------
    networks : Networks
        Their budget is not read.
    cases : sequence of Case
    order : Order
    """
    tables, data = [], []
    for case in cases:
        entries = [entry for a in networks.architectures if (entry := _entry(networks, case, a, order)) is not None]
        entries.sort(key=lambda entry: float(np.mean(entry.ratios)))
        tables.append(_table(case, entries, order))
        data.append({"mesh": case.shape.name, "radius": case.radius, "networks": [vars(entry) for entry in entries]})
    return Outcome("network_order", tables, {"rows": data}, {})


def _entry(networks: Networks, case: Case, architecture: Architecture, order: Order) -> Entry | None:
    short = Budget(None, max(1, order.steps // order.search_share), order.threads)
    tried = {rate: _trained(networks, case, architecture, short, Pace(order.batch, rate)) for rate in order.rates}
    losses = {rate: network.facts["validation_loss"] for rate, network in tried.items() if network is not None}
    if not losses:
        return None
    rate = min(losses, key=lambda rate: losses[rate])
    whole = Budget(None, order.steps, order.threads)
    entry = Entry(architecture.name, rate, [], [])
    for seed in order.seeds:
        network = _trained(networks, case, architecture, whole, Pace(order.batch, rate, seed))
        if network is None:
            return None
        entry.losses.append(float(network.facts["validation_loss"]))
        entry.ratios.append(float(networks.paper.to_fair(case, network.method) or np.nan))
    return entry


def _trained(
    networks: Networks, case: Case, architecture: Architecture, budget: Budget, pace: Pace
) -> TrainedNetwork | None:
    trainer = networks.trainer.with_budget(budget)
    return trainer.train(f"local-{case.shape.name}", [case.shape], networks.scale(case), architecture, pace)


def _table(case: Case, entries: Sequence[Entry], order: Order) -> Table:
    title = (
        f"{case.shape.name}, hole radius {case.radius}: {order.steps} steps of {order.batch} patches, best first "
        "(training and test share the mesh)"
    )
    columns = ["network", "rate"]
    columns += [f"held-out loss, seed {seed}" for seed in order.seeds]
    columns += [f"error / {FAIR}, seed {seed}" for seed in order.seeds]
    columns += ["mean", "half of the spread"]
    rows = []
    for entry in entries:
        spread = (max(entry.ratios) - min(entry.ratios)) / 2
        losses, ratios = [f"{loss:.6f}" for loss in entry.losses], [figure(value) for value in entry.ratios]
        rows.append(
            [entry.name, f"{entry.rate:g}", *losses, *ratios, figure(float(np.mean(entry.ratios))), figure(spread)]
        )
    return Table(title, columns, rows)
