"""``python -m benchmarks.quality BENCH``: repair quality on meshes whose truth is known, beside what the peers reach.

BENCH is the folder that holds ``bench.py`` (which punches holes and scores repairs), ``meshes/`` and
``baselines.json``. Tables go to the console; JSON, Markdown, plots and pictures to the output folder. A run that was
stopped goes on where it was. Meshes of the bench are for measuring only: models learned from them stay in that folder.

experiments
    repair        errors beside the peers', calibration of the confidence, the worst and the best hole of every mesh
    dictionaries  the paper's local, global, leave-one-out and self-similar dictionaries beside our own methods
    atoms         the paper's local dictionary, by its number of atoms
    patch-length  the paper's local dictionary and our `self`, by the ratio of hole to patch
    shapes        the paper's global dictionary, by the number of shapes that it was learned from
    rebuilding    whole meshes from their codes by the paper's local dictionary, by its number of atoms
    transfer      the holes of one half of a mesh, filled by what the other half teaches
    failures      the worst hole of every mesh by the paper's local dictionary
    networks      the paper's networks, trained on the spot, beside its dictionaries
    network-order the same networks by equal data, batch and steps, a rate found for each, and two seeds
"""

import argparse
import sys
from pathlib import Path

from benchmarks.quality.bench import RADII, Bench, BenchError
from benchmarks.quality.code_version import method_sha256
from benchmarks.quality.measurement import Method
from benchmarks.quality.network_options import PROTOCOLS, Budget, NetworkOptions, Order
from benchmarks.quality.own_meshes import own_shapes
from benchmarks.quality.results import ALL_KINDS, OF_THE_METHOD, Results
from benchmarks.quality.session import EXPERIMENTS, REPAIR, Session
from benchmarks.quality.smoothing import kept_smoothing
from quadpatch.errors import QuadpatchError

MODELS = ["smooth", "self", "general-dictionary"]
DEFAULT_RADIUS = "0.025"
ALL = "all"


def main() -> None:
    """Read the command line and run the experiments that it names."""
    arguments = _parser().parse_args()
    chosen = arguments.experiment or [REPAIR]
    try:
        session = _open(arguments)
        with kept_smoothing(arguments.output.parent / "smoothed"):
            for name in EXPERIMENTS if ALL in chosen else dict.fromkeys(chosen):
                EXPERIMENTS[name](session)
    except (BenchError, QuadpatchError) as error:
        sys.exit(f"error: {error}")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.quality", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("bench", type=Path, help="folder of the bench")
    names = [*EXPERIMENTS, ALL]
    parser.add_argument("--experiment", action="append", choices=names, help=f"repeat for more; default {REPAIR}")
    parser.add_argument("--meshes", type=Path, help="folder of meshes of your own, in place of the bench's")
    parser.add_argument("--mesh", action="append", help="just this mesh; repeat for more")
    parser.add_argument("--radius", action="append", help=f"hole radius; repeat for more, or all: {', '.join(RADII)}")
    parser.add_argument(
        "--model", action="append", help="smooth, self, self-network, auto, best, or a model; repeat for more"
    )
    parser.add_argument("--output", type=Path, default=Path("var/quality"), help="folder for meshes and results")
    parser.add_argument("--fresh", action="store_true", help="measure again; keep the paper's models and peers")
    parser.add_argument(
        "--fresh-all", action="store_true", help="learn dictionaries, train networks and run peers again, too"
    )
    parser.add_argument("--no-pictures", action="store_true", help="draw no worst and best holes, and no patches")
    _add_network_options(parser)
    return parser


def _add_network_options(parser: argparse.ArgumentParser) -> None:
    usual = NetworkOptions()
    networks = parser.add_argument_group("networks")
    networks.add_argument("--arch", action="append", help="network; repeat for more; default small_4x")
    networks.add_argument("--protocol", action="append", choices=PROTOCOLS, help="repeat for more; default local")
    networks.add_argument("--minutes", type=float, help=f"of training, each; default {usual.budget.minutes}")
    networks.add_argument("--steps", type=int, help="of training, each, at most; without --minutes the only limit")
    networks.add_argument("--batch", type=int, default=Order.batch, help="patches in a step (network-order)")
    networks.add_argument("--threads", type=int, default=usual.budget.threads, help="for training; default 1")


def _open(arguments: argparse.Namespace) -> Session:
    bench = Bench.open(arguments.bench)
    radii = arguments.radius or [DEFAULT_RADIUS]
    fresh = ALL_KINDS if arguments.fresh_all else OF_THE_METHOD if arguments.fresh else ()
    return Session(
        bench=bench,
        results=Results(arguments.output / "results", fresh, method_sha256()),
        every=own_shapes(bench, arguments.meshes, arguments.output) if arguments.meshes else bench.shapes(),
        names=arguments.mesh or [],
        radii=RADII if ALL in radii else radii,
        methods=[Method.of(model) for model in arguments.model or MODELS],
        output=arguments.output,
        is_drawing=not arguments.no_pictures,
        networks=_network_options(arguments),
    )


def _network_options(arguments: argparse.Namespace) -> NetworkOptions:
    usual = NetworkOptions()
    is_endless = arguments.minutes is None and arguments.steps is None
    minutes = usual.budget.minutes if is_endless else arguments.minutes
    budget = Budget(minutes, arguments.steps, arguments.threads)
    order = Order(steps=arguments.steps or Order.steps, batch=arguments.batch, threads=arguments.threads)
    return NetworkOptions(arguments.arch or usual.architectures, arguments.protocol or usual.protocols, budget, order)


if __name__ == "__main__":
    main()
