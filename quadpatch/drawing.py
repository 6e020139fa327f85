"""Pictures of a finished repair, drawn from its meshes in memory.

They are optional: the repaired mesh has been written when this runs, and what goes wrong here is a warning in the
report.
"""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from quadpatch.mesh.holes import Hole
from quadpatch.optional import failure_of
from quadpatch.picture.hole_pictures import NumberedHole, draw_hole
from quadpatch.picture.pair import Pair, prepare
from quadpatch.picture.sheet import render_before_after
from quadpatch.repair import RepairedFile


def add_picture(repaired: RepairedFile, picture: Path) -> None:
    """Draw the mesh before and after its repair, side by side, as a PNG file.

    Parameters
    ----------
    repaired : RepairedFile
        Its report gets the seconds of the stage `preview`, and a warning where there is no picture.
    picture : Path
    """
    filled = repaired.repair.filled
    with _stage(repaired.report, "preview"):
        failure = failure_of(
            lambda: render_before_after(repaired.measured, filled.mesh, filled.invented_triangles, picture)
        )
    if failure is not None:
        repaired.report["warnings"].append(f"there is no picture: {failure}")


def add_close_ups(repaired: RepairedFile, folder: Path) -> None:
    """Draw every chosen hole before and after, as `hole_<id>.png`.

    Parameters
    ----------
    repaired : RepairedFile
        Its report gets the seconds of the stage `closeups`, and a warning for each hole that could not be drawn.
    folder : Path
        Made where it is missing.
    """
    filled, pairs = repaired.repair.filled, list[Pair]()
    with _stage(repaired.report, "closeups"):
        failure = failure_of(
            lambda: pairs.append(prepare(repaired.measured, filled.mesh, filled.invented_triangles))
        ) or failure_of(lambda: folder.mkdir(parents=True, exist_ok=True))
        warnings = [] if failure is None else [f"there are no close-ups: {failure}"]
        for hole in repaired.repair.chosen if failure is None else []:
            warnings += _close_up(pairs[0], repaired, hole, folder)
    repaired.report["warnings"] += warnings


def _close_up(pair: Pair, repaired: RepairedFile, hole: Hole, folder: Path) -> list[str]:
    numbered = NumberedHole(hole.id, repaired.measured.vertices[hole.loop])
    failure = failure_of(lambda: draw_hole(pair, numbered, folder / f"hole_{hole.id}.png"))
    return [] if failure is None else [f"there is no close-up of hole {hole.id}: {failure}"]


@contextmanager
def _stage(report: dict[str, Any], name: str) -> Iterator[None]:
    """Add the seconds of what happens inside to a report."""
    start = time.perf_counter()
    yield
    report["stages"].append({"name": name, "seconds": round(time.perf_counter() - start, 4)})
