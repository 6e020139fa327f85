import re
from pathlib import Path

from deploy.lowest import lowest_versions

ROOT = Path(__file__).resolve().parents[2]


def test_every_package_that_runs_has_a_lowest_version_that_is_no_newer_than_the_tested_one() -> None:
    lowest = lowest_versions()
    assert {"numpy", "fastapi", "psycopg", "opentelemetry-sdk", "torch"} <= set(lowest)
    tested = dict(
        line.lower().replace("_", "-").split("==") for line in (ROOT / "constraints.txt").read_text("utf-8").split()
    )
    for name in lowest:
        assert numbers(lowest[name]) <= numbers(tested[name]), name


def numbers(version: str) -> list[int]:
    return [int(part) for part in re.findall(r"\d+", version.partition("+")[0])]
