"""The paper's network experiment: repairs by its six networks, beside its dictionaries and what is free.

Patches are as wide for every network, and for the dictionary: the largest networks show the same surface more finely.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from matplotlib.figure import Figure

from benchmarks.quality.bench import BenchError, Case, Shape
from benchmarks.quality.measurement import Method, measure
from benchmarks.quality.network_options import NetworkOptions, Protocol
from benchmarks.quality.network_pictures import Tile, choose_patches, completed_tiles, patch_picture
from benchmarks.quality.network_tables import DICTIONARY, Finding, mean_to_fair, network_tables
from benchmarks.quality.outcome import Outcome
from benchmarks.quality.paper_experiments import FAIR, MESHLAB, Paper
from benchmarks.quality.paper_networks import NetworkTrainer, TrainedNetwork, held_out_rows
from benchmarks.quality.plots import labelled_plot
from quadpatch.patches.scale import PatchScale
from training.architectures import Architecture, find_architecture

PAPER = "paper"
# Pictures show so many patches of each of the first so many meshes.
_N_PATCHES, _N_MESHES = 2, 3


@dataclass(frozen=True)
class Networks:
    """What all protocols have in common.

    Attributes
    ----------
    paper : Paper
        For the dictionaries that networks are compared with.
    trainer : NetworkTrainer
    all_shapes : sequence of Shape
        What global networks are trained on.
    architectures : sequence of Architecture
    """

    paper: Paper
    trainer: NetworkTrainer
    all_shapes: Sequence[Shape]
    architectures: Sequence[Architecture]

    def find(self, protocol: Protocol, case: Case) -> Finding:
        """Train, repair and measure, or take what was kept."""
        paper, finding = self.paper, Finding(case)
        trained = self.trained(protocol, case)
        for architecture in self.architectures:
            name, network = architecture.name, trained.get(architecture.name)
            finding.errors[name] = paper.error(case, network.method if network else None)
            if network is not None:
                measured = measure(paper.bench, case, network.method, paper.results)
                use = {"complete_s": measured["stages"]["inpaint"], "n_completed": measured["n_patches"]}
                finding.networks[name] = {**network.facts, **use, "resolution": architecture.resolution}
        finding.errors[DICTIONARY] = paper.error(case, self._dictionary(protocol, case))
        for peer in (MESHLAB, FAIR):
            finding.errors[peer] = float(case.peers[peer]["error"]) if peer in case.peers else None
        return finding

    def trained(self, protocol: Protocol, case: Case) -> dict[str, TrainedNetwork]:
        """Train the networks for a case, by name; those without enough patches are left out."""
        name, shapes = self._sources(protocol, case.shape)
        scale = self.scale(case)
        networks = {a.name: self.trainer.train(name, shapes, scale, a) for a in self.architectures}
        return {name: network for name, network in networks.items() if network is not None}

    def scale(self, case: Case) -> PatchScale:
        """Patch length and overlap for the holes of a case, the same for all meshes."""
        return self.paper.learner.scale(self.all_shapes, case.radius)

    def tiles(self, protocol: Protocol, case: Case) -> list[dict[str, Tile]]:
        """Complete some patches of the undamaged mesh by every network, for a picture."""
        trained, scale = self.trained(protocol, case), self.scale(case)
        cut = {
            a.resolution: self.trainer.patches(case.shape, replace(scale, resolution=a.resolution))
            for a in self.architectures
        }
        known = cut[min(cut)]["known"]
        rows = choose_patches(known, held_out_rows(len(known)).tolist(), _N_PATCHES)
        files = {name: Path(network.method.model) for name, network in trained.items()}
        share = 2 * float(case.radius) / scale.length
        return [completed_tiles(case.shape.name, row, cut, files, share) for row in rows]

    def _dictionary(self, protocol: Protocol, case: Case) -> Method | None:
        learner, scale = self.paper.learner, self.scale(case)
        if protocol == "local":
            return learner.local(case.shape, scale)
        return learner.many(*self._sources(protocol, case.shape), scale)

    def _sources(self, protocol: Protocol, shape: Shape) -> tuple[str, list[Shape]]:
        if protocol == "local":
            return f"local-{shape.name}", [shape]
        if protocol == "global":
            return "global", list(self.all_shapes)
        return f"without-{shape.name}", [other for other in self.all_shapes if other.name != shape.name]


def find_architectures(names: Sequence[str]) -> list[Architecture]:
    """Look up networks.

    Raises
    ------
    OptionError
        If there is none of a name.
    BenchError
        If one is none of the paper's.
    """
    architectures = [find_architecture(name) for name in dict.fromkeys(names)]
    for architecture in architectures:
        if architecture.recipe != PAPER:
            raise BenchError(f"{architecture.name} is none of the paper's networks")
    return architectures


def networks_experiment(
    networks: Networks, cases: Sequence[Case], options: NetworkOptions, is_drawing: bool
) -> Outcome:
    """Measure every network on every case, by every protocol.

    Parameters
    ----------
    networks : Networks
    cases : sequence of Case
    options : NetworkOptions
    is_drawing : bool
        Whether patches are drawn.

    Returns
    -------
    Outcome
        Three tables and, of several networks, a plot of error against parameters, for each protocol and radius; a
        picture of patches for each protocol.
    """
    tables, plots, data = [], {}, []
    for protocol in options.protocols:
        for radius in dict.fromkeys(case.radius for case in cases):
            findings = [networks.find(protocol, case) for case in cases if case.radius == radius]
            tables += network_tables(protocol, findings)
            if len(networks.architectures) > 1:
                plots[f"parameters_{protocol}_{radius}"] = _plot(protocol, findings)
            for f in findings:
                row = {"mesh": f.case.shape.name, "radius": radius, "protocol": protocol}
                data.append({**row, "errors": f.errors, "networks": f.networks})
        if is_drawing:
            rows = [tiles for case in cases[:_N_MESHES] for tiles in networks.tiles(protocol, case)]
            plots |= {f"patches_{protocol}": patch_picture(rows)} if rows else {}
    return Outcome("networks", tables, {"rows": data}, plots)


def _plot(protocol: Protocol, findings: Sequence[Finding]) -> Figure:
    """Draw the networks' errors against their parameters."""
    points = {}
    for name in findings[0].networks:
        mean = mean_to_fair(findings, name)
        if mean is not None:
            points[name] = float(findings[0].networks[name]["n_parameters"]), mean
    lines = {name: mean for name in (DICTIONARY, MESHLAB) if (mean := mean_to_fair(findings, name)) is not None}
    meshes = ", ".join(f.case.shape.name for f in findings)
    title = f"{protocol}, hole radius {findings[0].case.radius}: {meshes}"
    return labelled_plot(title, ("parameters", f"error / {FAIR}, geometric mean"), points, lines)
