"""The command line of the quality benchmark, from a small bench to tables, plots and pictures.

It goes through `benchmarks.quality.session`, `benchmarks.quality.repair_experiment`, `benchmarks.quality.pictures` and
`benchmarks.quality.sheets`.
"""

import json
import sys
from pathlib import Path

import pytest
from PIL import Image

from benchmarks.quality.__main__ import main
from tests.benchmarks.quality.small_bench import SHAPES, small_bench


def test_a_repair_is_measured_tabled_and_drawn(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    small_bench(tmp_path / "bench")
    output = tmp_path / "out"
    arguments = [str(tmp_path / "bench"), "--mesh", SHAPES[0], "--radius", "0.1", "--model", "smooth"]
    monkeypatch.setattr(sys, "argv", ["quality", *arguments, "--output", str(output)])
    main()
    data = json.loads((output / "repair.json").read_text())
    (row,) = data["rows"]
    assert (row["mesh"], row["radius"], row["errors"]["smooth"], row["errors"]["fair"]) == (SHAPES[0], "0.1", 0.5, 0.25)
    (repaired,) = data["repairs"]
    (hole,) = repaired["per_hole"]
    assert hole["true_error"] > 0
    assert "hole radius 0.1" in (output / "repair.md").read_text()
    assert "hole radius 0.1" in capsys.readouterr().out
    for plot in ("ratios_0.1", "calibration"):
        assert (output / f"repair_{plot}.png").is_file()
    with Image.open(output / "pictures" / f"{SHAPES[0]}_0.1_smooth.png") as picture:
        assert len(picture.getcolors(1 << 20) or []) > 100


def test_a_folder_that_is_no_bench_ends_with_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["quality", str(tmp_path)])
    with pytest.raises(SystemExit, match=r"^error: there is no .*bench\.py"):
        main()
