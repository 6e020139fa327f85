from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from PIL import Image
from rich.console import Console

from benchmarks.quality.outcome import Outcome
from benchmarks.quality.tables import Table


def test_tables_figures_plots_and_pictures_are_written_and_named_in_the_document(tmp_path: Path) -> None:
    grey = np.broadcast_to(np.arange(256, dtype=np.uint8)[:, None, None], (256, 40, 3))
    picture = Image.fromarray(np.ascontiguousarray(grey))
    table = Table("errors", ["mesh", "ours"], [["igea", "0.97"]])
    outcome = Outcome("some", [table], {"x": [1]}, {"curve": Figure(), "two_meshes": picture})
    console = Console(width=80)
    with console.capture() as capture:
        outcome.publish(tmp_path, console)
    assert "igea" in capture.get()
    assert (tmp_path / "some.json").read_text() == '{\n "x": [\n  1\n ]\n}\n'
    text = (tmp_path / "some.md").read_text()
    for words in ("| igea | 0.97 |", "![some: curve](some_curve.png)", "![some: two meshes](some_two_meshes.png)"):
        assert words in text
    with Image.open(tmp_path / "some_curve.png") as curve:
        assert curve.format == "PNG"
    with Image.open(tmp_path / "some_two_meshes.png") as drawn:
        difference = np.asarray(drawn.convert("RGB")).astype(int) - grey
    # A palette stands for the colours.
    assert np.abs(difference).max() <= 3
