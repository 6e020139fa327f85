import json
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.repair import inspect_file
from quadpatch.views.outlines import write_outlines
from tests.quadpatch.shapes import bumpy_plate, moved, on_surface, plate_with_disc, punched, sphere, write_ply


def outlines_of(path: Path) -> dict[str, Any]:
    write_outlines(path, path.with_suffix(".json"))
    found: dict[str, Any] = json.loads(path.with_suffix(".json").read_text())
    return found


def test_outlines_have_the_ids_and_measures_of_the_analysis(tmp_path: Path) -> None:
    plate = bumpy_plate(60, 4.0)
    mesh = moved(punched(plate, *on_surface(plate, (-1.0, -1.0), (0.9, 0.2)), radius=0.25), (1e6, 0.0, 0.0))
    path = write_ply(tmp_path / "scan.ply", mesh)
    facts, outlines = inspect_file(path), outlines_of(path)
    assert outlines["n_holes"] == len(facts["holes"]) == len(outlines["holes"]) == 3
    for known, found in zip(facts["holes"], outlines["holes"], strict=True):
        assert {name: known[name] for name in ("id", "kind", "diameter", "centre", "normal")} == {
            name: found[name] for name in ("id", "kind", "diameter", "centre", "normal")
        }
        rim = np.array(found["rim"]) + outlines["origin"]
        assert len(rim) == known["edges"]
        assert not found["is_thinned"]
        assert np.allclose(rim.min(axis=0), known["bounding_box"]["min"], atol=1e-4)
        assert np.allclose(rim.max(axis=0), known["bounding_box"]["max"], atol=1e-4)


def test_long_rims_are_thinned(tmp_path: Path) -> None:
    outlines = outlines_of(write_ply(tmp_path / "disc.ply", plate_with_disc(2000)))
    rims = [np.array(hole["rim"]) for hole in outlines["holes"]]
    assert [len(rim) for rim in rims] == [512, 512]
    assert all(hole["is_thinned"] for hole in outlines["holes"])
    steps = np.linalg.norm(rims[1] - np.roll(rims[1], 1, axis=0), axis=1)
    assert steps.max() < 1.5 * steps.min()


def test_a_closed_mesh_has_none(tmp_path: Path) -> None:
    assert outlines_of(write_ply(tmp_path / "ball.ply", sphere(2)))["holes"] == []
