"""The experiments by name, and what the command line opened for them.

Tested in `tests/benchmarks/quality/test_main.py`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console

from benchmarks.quality.bench import Bench, Case, Shape, named
from benchmarks.quality.failures import failures_experiment
from benchmarks.quality.measurement import Method
from benchmarks.quality.network_options import NetworkOptions
from benchmarks.quality.outcome import Outcome, Progress
from benchmarks.quality.paper_dictionaries import Learner
from benchmarks.quality.paper_experiments import (
    ATOMS,
    HELD_OUT,
    HOLE_TO_PATCH,
    N_DICTIONARIES,
    N_SHAPES,
    Paper,
    atoms_experiment,
    dictionaries_experiment,
    patch_length_experiment,
    shapes_experiment,
)
from benchmarks.quality.peers import with_peers
from benchmarks.quality.pictures import draw_extremes
from benchmarks.quality.rebuilding_experiment import Rebuilder, rebuilding_experiment
from benchmarks.quality.repair_experiment import repair_experiment
from benchmarks.quality.results import Results
from benchmarks.quality.transfer_experiment import DEFAULT_MESH, N_TRANSFERS, transfer_experiment
from quadpatch.model_choice import SELF

REPAIR = "repair"
# Tables are wide; into a file they go as they are.
_WIDTH = 160


@dataclass(frozen=True)
class Session:
    """What the command line opened.

    Attributes
    ----------
    bench : Bench
    results : Results
    every : sequence of Shape
        All shapes that there are.
    names : sequence of str
        Those asked for; empty for the experiment's own choice.
    radii : sequence of str
        Experiments that draw curves take the first.
    methods : sequence of Method
    output : Path
    is_drawing : bool
        Whether pictures of holes and patches are wanted.
    networks : NetworkOptions
        For the paper's networks.
    """

    bench: Bench
    results: Results
    every: Sequence[Shape]
    names: Sequence[str]
    radii: Sequence[str]
    methods: Sequence[Method]
    output: Path
    is_drawing: bool
    networks: NetworkOptions

    def cases(self, radii: Sequence[str], otherwise: Sequence[str] = ()) -> list[Case]:
        """Punch the shapes asked for, otherwise some or all, and see to it that there are figures of peers."""
        shapes = named(self.every, self.names or otherwise)
        cases = [self.bench.case(shape, radius, self.output) for radius in radii for shape in shapes]
        return [with_peers(self.bench, case, self.results) for case in cases]

    def paper(self, n_steps: int) -> Paper:
        """Prepare for experiments with the paper's dictionaries, which stay in the output folder."""
        learner = Learner(self.bench, self.results, self.output / "models")
        return Paper(self.bench, self.results, learner, Progress(n_steps))

    def publish(self, outcome: Outcome) -> None:
        """Print the tables and write everything."""
        console = Console()
        outcome.publish(self.output, console if console.is_terminal else Console(width=_WIDTH))


def _repair(session: Session) -> None:
    cases = session.cases(session.radii)
    n_steps = len(cases) * len(session.methods)
    session.publish(repair_experiment(session.bench, cases, session.methods, session.results, Progress(n_steps)))
    progress = Progress(n_steps)
    for case in cases if session.is_drawing else []:
        for method in session.methods:
            picture = draw_extremes(session.bench, case, method, session.results, session.output / "pictures")
            progress.step(f"picture {picture}")


def _dictionaries(session: Session) -> None:
    cases = session.cases(session.radii)
    paper = session.paper(len(cases) * (N_DICTIONARIES + len(session.methods)))
    session.publish(dictionaries_experiment(paper, cases, session.every, session.methods))


def _atoms(session: Session) -> None:
    cases = session.cases(session.radii[:1])
    session.publish(atoms_experiment(session.paper(len(cases) * len(ATOMS)), cases, session.every))


def _patch_length(session: Session) -> None:
    cases = session.cases(session.radii[:1])
    # The other methods bring their own patches, or have none.
    methods = [method for method in session.methods if method.model == SELF]
    paper = session.paper(len(cases) * len(HOLE_TO_PATCH) * (1 + len(methods)))
    session.publish(patch_length_experiment(paper, cases, methods))


def _shapes(session: Session) -> None:
    held_out = [shape.name for shape in session.every if shape.name in HELD_OUT]
    cases = session.cases(session.radii[:1], held_out or [session.every[0].name])
    paper = session.paper(len(cases) * len(N_SHAPES))
    session.publish(shapes_experiment(paper, cases, session.every))


def _rebuilding(session: Session) -> None:
    shapes = named(session.every, session.names)
    paper = session.paper(len(shapes) * len(ATOMS))
    scale = paper.learner.scale(session.every, session.radii[0])
    session.publish(rebuilding_experiment(Rebuilder(paper, scale, session.output / "rebuilt"), shapes))


def _transfer(session: Session) -> None:
    usual = [shape.name for shape in session.every if shape.name == DEFAULT_MESH] or [session.every[0].name]
    shapes = named(session.every, session.names or usual)
    paper = session.paper(len(shapes) * N_TRANSFERS)
    session.publish(transfer_experiment(paper, shapes, session.every, session.radii[0], session.output))


def _failures(session: Session) -> None:
    cases = session.cases(session.radii[:1])
    session.publish(failures_experiment(session.paper(len(cases)), cases, session.every))


def _networks(session: Session) -> None:
    # Torch is slow to load, and no other experiment needs it.
    from benchmarks.quality.network_experiment import (  # noqa: PLC0415
        Networks,
        find_architectures,
        networks_experiment,
    )
    from benchmarks.quality.paper_networks import NetworkTrainer  # noqa: PLC0415

    options = session.networks
    architectures = find_architectures(options.architectures)
    cases = session.cases(session.radii)
    paper = session.paper(len(cases) * len(options.protocols) * (len(architectures) + 1))
    trainer = NetworkTrainer(session.bench, session.results, session.output / "networks", options.budget)
    networks = Networks(paper, trainer, session.every, architectures)
    session.publish(networks_experiment(networks, cases, options, session.is_drawing))


def _network_order(session: Session) -> None:
    from benchmarks.quality.network_experiment import Networks, find_architectures  # noqa: PLC0415  see above
    from benchmarks.quality.network_order import network_order_experiment  # noqa: PLC0415
    from benchmarks.quality.paper_networks import NetworkTrainer  # noqa: PLC0415

    options = session.networks
    architectures = find_architectures(options.architectures)
    cases = session.cases(session.radii)
    paper = session.paper(len(cases) * len(architectures) * len(options.order.seeds))
    trainer = NetworkTrainer(session.bench, session.results, session.output / "networks", options.budget)
    networks = Networks(paper, trainer, session.every, architectures)
    session.publish(network_order_experiment(networks, cases, options.order))


EXPERIMENTS: dict[str, Callable[[Session], None]] = {
    REPAIR: _repair,
    "dictionaries": _dictionaries,
    "atoms": _atoms,
    "patch-length": _patch_length,
    "shapes": _shapes,
    "rebuilding": _rebuilding,
    "transfer": _transfer,
    "failures": _failures,
    "networks": _networks,
    "network-order": _network_order,
}
