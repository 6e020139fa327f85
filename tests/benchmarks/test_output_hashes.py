import subprocess
import sys
from pathlib import Path

import pytest

from tests.quadpatch.shapes import open_grid, punched, write_ply

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.slow
def test_the_same_repair_has_the_same_hashes_and_another_one_others(tmp_path: Path) -> None:
    for name, radius in (("one.ply", 2.0), ("two.ply", 3.0)):
        write_ply(tmp_path / name, punched(open_grid(20), (0.0, 0.0, 0.0), radius=radius))
    command = [sys.executable, "-m", "benchmarks.output_hashes", str(tmp_path), "--model", "smooth"]
    first, again = (subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True) for _ in range(2))
    assert first.stdout == again.stdout
    one, two = (line.split() for line in first.stdout.splitlines())
    assert (one[2:], two[2:]) == (["one.ply", "smooth"], ["two.ply", "smooth"])
    assert one[0] != two[0]
    assert one[1] != two[1]
