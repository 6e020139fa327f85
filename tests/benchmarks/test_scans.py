"""Also tests `benchmarks.scan_pictures`."""

import json
from pathlib import Path

import pytest
from PIL import Image

from benchmarks.scans import main
from tests.quadpatch.shapes import bumpy_plate, punched, write_ply


@pytest.mark.slow
def test_scans_are_repaired_judged_and_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A plate has a border, which stays open, and two holes."""
    plate = punched(bumpy_plate(30, 2.0), (-0.4, -0.4, 0), (0.5, 0.4, 0), radius=0.15)
    write_ply(tmp_path / "plate_raw.ply", plate)
    (tmp_path / "broken_raw.ply").write_text("ply\n")
    (tmp_path / "notes_raw.txt").write_text("no mesh")
    output = tmp_path / "results"
    main([str(tmp_path), "--match", "*_raw*", "--model", "smooth", "--output", str(output)])

    broken, whole = json.loads((output / "scans.json").read_text())["scans"]
    assert broken["error"].startswith("unreadable_mesh: ")
    assert (whole["counts"]["found"], whole["counts"]["filled_smooth"], whole["error"]) == (3, 2, "")
    assert whole["found"]["is_kept"]
    assert (whole["found"]["folds"], whole["found"]["crossings"]) == (0, 0)
    assert whole["cpu_s"] > 0
    assert whole["peak_mb"] > 10
    lines = (output / "loops_plate_raw_smooth.tsv").read_text().splitlines()
    assert [line.split("\t")[3] for line in lines] == ["verdict", "skipped", "filled_smooth", "filled_smooth"]
    assert "skipped border" in (output / "scans.md").read_text()
    assert "plate_raw" in capsys.readouterr().out
    with Image.open(output / "pictures" / "plate_raw_smooth_loops.png") as picture:
        assert len(picture.getcolors(1 << 20) or []) > 100
    assert (output / "pictures" / "plate_raw_smooth.png").is_file()


def test_a_folder_without_scans_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(SystemExit, match="no mesh"):
        main([str(tmp_path)])
