"""`python -m tests.faults`, or `make faults`: the whole suite, and its figures as a table.

The exit code is 1 where a guarantee was violated, or a time limit was exceeded.
"""

import argparse
import logging
import sys
import tempfile
from pathlib import Path

from tests.faults.campaign import Campaign, run_campaign
from tests.faults.load import Workload
from tests.faults.table import to_text
from tests.faults.violations import all_violations


def main(arguments: list[str]) -> int:
    """Run one campaign; returns the exit code."""
    parser = argparse.ArgumentParser(prog="make faults ARGS=...", description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of the random numbers")
    parser.add_argument("--jobs", type=int, default=300, help="accepted jobs, at least")
    parser.add_argument("--rounds", type=int, default=4, help="how often each outage is injected; kills twice as often")
    parser.add_argument("--backend", choices=("sqlite-local", "postgres-s3"), default="postgres-s3")
    parser.add_argument("--loopback", action="store_true", help="make no network namespaces")
    parser.add_argument("--keep", type=Path, help="folder for logs and data, kept; default: a temporary one")
    chosen = parser.parse_args(arguments)
    logging.basicConfig(level=logging.INFO, format="%(asctime)s %(message)s")
    logging.getLogger("httpx").setLevel(logging.WARNING)
    campaign = Campaign(
        Workload(chosen.seed, chosen.jobs),
        chosen.backend,
        chosen.rounds,
        wants_namespaces=not chosen.loopback,
        kills_per_outage=2,
    )
    if chosen.keep is not None:
        chosen.keep.mkdir(parents=True)
        return _run(campaign, chosen.keep)
    with tempfile.TemporaryDirectory(prefix="quadpatch-faults-") as folder:
        return _run(campaign, Path(folder))


def _run(campaign: Campaign, folder: Path) -> int:
    outcome = run_campaign(campaign, folder)
    violations = all_violations(outcome)
    sys.stdout.write(f"\n{campaign.backend}, seed {campaign.workload.seed}\n{to_text(outcome)}\n")
    sys.stdout.write("".join(f"VIOLATION: {line}\n" for line in violations) or "no violations\n")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
