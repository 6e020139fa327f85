"""`python -m tests.mutants`, or `make mutants`: mutated files of all formats through a real local stack, and a table.

The exit code is 1 where a file got no answer with a code or a mesh, a process was lost, a file stayed in the folders of
work, or a process grew by more than `MOST_GROWTH_MB`. Files with a fault stay in a folder.
"""

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import httpx
import psutil

from onebox.demo import running_stack
from tests.mutants.bases import made, real
from tests.mutants.campaign import Outcome, Peaks, left_behind, mutant, peaks, send_all
from tests.waiting import GUARD_S, wait_until

MOST_GROWTH_MB = 200.0


def main(arguments: list[str]) -> int:
    """Run one campaign; returns the exit code."""
    parser = argparse.ArgumentParser(prog="make mutants ARGS=...", description=__doc__)
    parser.add_argument("--count", type=int, default=500, help="files; default 500")
    parser.add_argument("--first", type=int, default=0, help="number of the first one; default 0")
    parser.add_argument("--seed", type=int, default=1, help="of all chance; default 1")
    parser.add_argument("--keep", type=Path, default=Path("var/mutants"), help="folder for files with a fault")
    chosen = parser.parse_args(arguments)
    files = real()
    if not files:
        sys.stderr.write("no real files: there is no folder shared beside this repository\n")
    files |= made()
    mutants = [mutant(files, chosen.seed, chosen.first + i) for i in range(chosen.count)]
    with tempfile.TemporaryDirectory(prefix="quadpatch-mutants-") as folder, running_stack(Path(folder)) as url:
        (local_stack,) = [p for p in psutil.Process().children() if folder in p.cmdline()]
        before = peaks(local_stack)
        outcomes = send_all(url, mutants)
        wait_until(lambda: not left_behind(Path(folder)))
        after = peaks(local_stack)
        httpx.get(f"{url}/v1/jobs", params={"limit": 100}, timeout=GUARD_S).raise_for_status()
    faulty = [outcome for outcome in outcomes if outcome.fault]
    keep(faulty, chosen.keep)
    lines = memory_faults(before, after)
    sys.stdout.write(to_text(outcomes) + memory_text(before, after) + "".join(f"NOT KEPT: {line}\n" for line in lines))
    return 1 if faulty or lines else 0


def keep(faulty: Sequence[Outcome], folder: Path) -> None:
    """Write the files that got no answer, and say why."""
    for outcome in faulty:
        folder.mkdir(parents=True, exist_ok=True)
        one = outcome.mutant
        path = folder / f"{one.number}_{one.kind.replace(' ', '_')}{Path(one.origin).suffix}"
        path.write_bytes(one.data)
        sys.stderr.write(f"{path} ({one.origin}, sent as {one.filename!r}): {outcome.fault}\n")


def to_text(outcomes: Sequence[Outcome]) -> str:
    """Count the answers, one line for each code."""
    counts = Counter(outcome.answer or "no answer" for outcome in outcomes)
    lines = [f"{name:28} {count:5}\n" for name, count in counts.most_common()]
    n_faulty = sum(bool(outcome.fault) for outcome in outcomes)
    return "".join(lines) + f"{'all':28} {len(outcomes):5}\n{'with a fault':28} {n_faulty:5}\n"


def memory_text(before: Peaks, after: Peaks) -> str:
    """Print the peaks of each process before and after."""
    rows = [(name, pid, before.mb.get((name, pid), 0.0), mb) for (name, pid), mb in sorted(after.mb.items())]
    return "".join(f"{name:20} {pid:8}  peak {old:6.0f} -> {new:6.0f} MiB\n" for name, pid, old, new in rows)


def memory_faults(before: Peaks, after: Peaks) -> list[str]:
    """Say which processes were lost, or grew too far."""
    lost = [f"{name} {pid} was lost" for name, pid in before.mb.keys() - after.mb.keys()]
    grown = [
        f"{name} {pid} grew by {after.mb[name, pid] - mb:.0f} MiB"
        for (name, pid), mb in before.mb.items()
        if (name, pid) in after.mb and after.mb[name, pid] - mb > MOST_GROWTH_MB
    ]
    return [*lost, *grown]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
