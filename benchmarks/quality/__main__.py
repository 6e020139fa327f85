"""``python -m benchmarks.quality BENCH``: repair quality on meshes whose truth is known, beside what the peers reach.

BENCH is the folder that holds ``bench.py`` (which punches holes and scores repairs), ``meshes/`` and
``baselines.json``. Tables go to the console; JSON, Markdown, plots and pictures to the output folder. A run that was
stopped goes on where it was. Meshes of the bench are for measuring only: models learned from them stay in that folder.
"""

import argparse
import sys
from pathlib import Path

from rich.console import Console

from benchmarks.quality.bench import RADII, Bench, BenchError, Case
from benchmarks.quality.measurement import Method
from benchmarks.quality.outcome import Progress
from benchmarks.quality.own_meshes import own_shapes
from benchmarks.quality.peers import with_peers
from benchmarks.quality.pictures import draw_extremes
from benchmarks.quality.repair_experiment import repair_experiment
from benchmarks.quality.results import Results
from quadpatch.errors import QuadpatchError

MODELS = ["smooth", "self", "general-dictionary"]
DEFAULT_RADIUS = "0.025"
# Tables are wide; into a file they go as they are.
WIDTH = 160


def main() -> None:
    """Read the command line and run the experiments that it names."""
    arguments = _parser().parse_args()
    try:
        run(arguments)
    except (BenchError, QuadpatchError) as error:
        sys.exit(f"error: {error}")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.quality", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("bench", type=Path, help="folder of the bench")
    parser.add_argument("--meshes", type=Path, help="folder of meshes of your own, in place of the bench's")
    parser.add_argument("--mesh", action="append", help="just this mesh; repeat for more")
    parser.add_argument("--radius", action="append", help=f"hole radius; repeat for more, or all: {', '.join(RADII)}")
    parser.add_argument("--model", action="append", help="smooth, self, or a model; repeat for more")
    parser.add_argument("--output", type=Path, default=Path("var/quality"), help="folder for meshes and results")
    parser.add_argument("--fresh", action="store_true", help="take no result of an earlier run")
    parser.add_argument("--no-pictures", action="store_true", help="draw no worst and best holes")
    return parser


def run(arguments: argparse.Namespace) -> None:
    """Run what the command line asks for."""
    bench = Bench.open(arguments.bench)
    results = Results(arguments.output / "results", arguments.fresh)
    methods = [Method.of(model) for model in arguments.model or MODELS]
    cases = _cases(bench, arguments, results)
    progress = Progress(len(cases) * len(methods))
    outcome = repair_experiment(bench, cases, methods, results, progress)
    outcome.publish(arguments.output, _console())
    if not arguments.no_pictures:
        progress = Progress(len(cases) * len(methods))
        for case in cases:
            for method in methods:
                progress.step(f"picture {draw_extremes(bench, case, method, results, arguments.output / 'pictures')}")


def _cases(bench: Bench, arguments: argparse.Namespace, results: Results) -> list[Case]:
    radii = arguments.radius or [DEFAULT_RADIUS]
    if "all" in radii:
        radii = list(RADII)
    if arguments.meshes:
        shapes = own_shapes(bench, arguments.meshes, arguments.output, arguments.mesh)
    else:
        shapes = bench.shapes(arguments.mesh)
    cases = [bench.case(shape, radius, arguments.output) for radius in radii for shape in shapes]
    return [with_peers(bench, case, results) for case in cases]


def _console() -> Console:
    console = Console()
    return console if console.is_terminal else Console(width=WIDTH)


if __name__ == "__main__":
    main()
