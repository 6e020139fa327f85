"""Pictures of a finished repair or another task, drawn from its meshes in memory.

They are optional: the repaired mesh has been written when this runs, and what goes wrong here is a warning in the
report.
"""

import io
import time
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.formats.output_files import write_whole
from quadpatch.mesh.holes import Hole
from quadpatch.preview.comparison import render_comparison
from quadpatch.preview.hole_pictures import NumberedHole, draw_hole
from quadpatch.preview.invented import Invented
from quadpatch.preview.pair import Pair, filled_pair
from quadpatch.preview.parts import part_of
from quadpatch.preview.sheet import render_before_after
from quadpatch.preview.thinning import MOST_TRIANGLES, thinned
from quadpatch.preview.viewpoints import most_seen_from
from quadpatch.progress import Progress, no_progress
from quadpatch.recipes.result import Repair
from quadpatch.repair import RepairedFile
from quadpatch.stages import failure_of, peak_memory_mib
from quadpatch.tasks.result import TaskResult
from quadpatch_rules.coded_warnings import add_warning, warning
from quadpatch_rules.option_words import Tint

# Of an archive of close-ups. One takes about a tenth of a second of a core and a hundred kilobytes.
MOST_CLOSE_UPS = 100
MOST_CLOSE_UP_BYTES = 32 << 20

# The earliest moment that the format can state: equal pictures make equal archives.
_ZIP_EPOCH = (1980, 1, 1, 0, 0, 0)
_UNIX = 3
_READABLE_FILE = 0o100644 << 16


def add_picture(repaired: RepairedFile, picture: Path, tint: Tint = "invented") -> None:
    """Draw the mesh before and after its repair, side by side, as a PNG file.

    Parameters
    ----------
    repaired : RepairedFile
        Its report gets the seconds of the stage `preview`, and a warning where there is no picture.
    picture : Path
    tint : str
        What the colours of invented surface say: that it is invented, or its confidence.
    """
    with _stage(repaired.report, "preview"):
        failure = failure_of(
            lambda: render_before_after(repaired.repair.filled.mesh, invented_in(repaired.repair, tint), picture)
        )
    if failure is not None:
        add_warning(repaired.report, warning("no_preview", reason=failure))


def add_comparison(result: TaskResult, picture: Path) -> None:
    """Draw the mesh before and after a task, side by side, as a PNG file.

    Parameters
    ----------
    result : TaskResult
        Its report gets the seconds of the stage `preview`, and a warning where there is no picture.
    picture : Path
    """
    change = result.changed if result.shift is None else result.shift
    with _stage(result.report, "preview"):
        failure = failure_of(lambda: render_comparison(result.before, result.after, change, picture))
    if failure is not None:
        add_warning(result.report, warning("no_preview", reason=failure))


def invented_in(repair: Repair, tint: Tint) -> Invented:
    """Take what a repair invented, with its confidence where the tint shows that."""
    filled, chosen = repair.filled, repair.chosen
    hole = np.full(len(filled.mesh.triangles), -1)
    hole[filled.n_measured_triangles :] = np.array([hole.id for hole in chosen], np.int64)[filled.triangle_hole]
    if tint == "invented":
        return Invented(hole)
    known = [repair.results[hole.id].confidence for hole in chosen]
    confidence = np.full(len(hole), np.nan)
    of_hole = np.array([np.nan if value is None else value for value in known], np.float64)
    confidence[filled.n_measured_triangles :] = of_hole[filled.triangle_hole]
    return Invented(hole, confidence)


def add_close_ups(repaired: RepairedFile, folder: Path, tint: Tint = "invented") -> None:
    """Draw every chosen hole before and after, as `hole_<id>.png`.

    Parameters
    ----------
    repaired : RepairedFile
        Its report gets the seconds of the stage `closeups`, and a warning for each hole that could not be drawn.
    folder : Path
        Made where it is missing.
    tint : str
        As for `add_picture`.
    """

    def save(id_: int, picture: bytes) -> None:
        write_whole(folder / _name(id_), picture)

    with _stage(repaired.report, "closeups"):
        failure = failure_of(lambda: folder.resolve().mkdir(parents=True, exist_ok=True))
        if failure is None:
            _draw_each(repaired, repaired.repair.chosen, save, tint, no_progress)
        else:
            add_warning(repaired.report, warning("no_close_ups", reason=failure))


def add_close_up_archive(
    repaired: RepairedFile,
    archive: Path,
    progress: Progress = no_progress,
    most: int = MOST_CLOSE_UPS,
    tint: Tint = "invented",
) -> None:
    """Draw the widest chosen holes before and after, as `hole_<id>.png` in one ZIP file.

    Parameters
    ----------
    repaired : RepairedFile
        Its report gets the seconds of the stage `closeups`, and a warning for what is left out.
    archive : Path
        Empty where no hole was chosen, not written where none could be drawn. Equal repairs give equal bytes.
    progress : callable
    most : int
        At most so many holes, in at most `MOST_CLOSE_UP_BYTES`.
    tint : str
        As for `add_picture`.
    """
    with _stage(repaired.report, "closeups"):
        failure = failure_of(lambda: _write_archive(repaired, archive, progress, most, tint))
    if failure is not None:
        add_warning(repaired.report, warning("no_close_ups", reason=failure))


def draw_widest(
    repaired: RepairedFile, most: int, most_bytes: int, progress: Progress = no_progress, tint: Tint = "invented"
) -> dict[int, bytes]:
    """Draw the widest chosen holes before and after, at most so many in so many bytes.

    Parameters
    ----------
    repaired : RepairedFile
        Its report gets a warning for each hole that could not be drawn.
    most, most_bytes : int
    progress : callable
    tint : str
        As for `add_picture`.

    Returns
    -------
    dict of int to bytes
        PNG files by the ids of the holes, the widest first.
    """
    pictures: dict[int, bytes] = {}

    def is_full() -> bool:
        return sum(map(len, pictures.values())) > most_bytes

    _draw_each(repaired, _widest_first(repaired)[:most], pictures.__setitem__, tint, progress, is_full)
    if is_full():
        pictures.popitem()
    return pictures


def _widest_first(repaired: RepairedFile) -> list[Hole]:
    return sorted(repaired.repair.chosen, key=lambda hole: (-hole.diameter, hole.id))


def _write_archive(repaired: RepairedFile, archive: Path, progress: Progress, most: int, tint: Tint) -> None:
    chosen = _widest_first(repaired)
    packed, n_packed, is_full = io.BytesIO(), 0, False
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_STORED) as pack:

        def save(id_: int, picture: bytes) -> None:
            nonlocal n_packed, is_full
            is_full = is_full or packed.tell() + len(picture) > MOST_CLOSE_UP_BYTES
            if not is_full:
                pack.writestr(_entry(_name(id_)), picture)
                n_packed += 1

        _draw_each(repaired, chosen[:most], save, tint, progress, lambda: is_full)
    if is_full or len(chosen) > most:
        add_warning(repaired.report, warning("close_ups_limited", shown=n_packed, holes=len(chosen)))
    if n_packed or not chosen:
        write_whole(archive, packed.getvalue())


def _name(id_: int) -> str:
    return f"hole_{id_}.png"


def _entry(name: str) -> zipfile.ZipInfo:
    entry = zipfile.ZipInfo(name, _ZIP_EPOCH)
    entry.create_system, entry.external_attr = _UNIX, _READABLE_FILE
    return entry


def _draw_each(
    repaired: RepairedFile,
    holes: list[Hole],
    save: Callable[[int, bytes], None],
    tint: Tint,
    progress: Progress,
    is_full: Callable[[], bool] = lambda: False,
) -> None:
    """Draw holes one by one until it is enough, and add a warning for each that could not be drawn."""
    pairs = list[Pair]()
    if not holes:
        return
    failure = failure_of(lambda: pairs.append(_pair_around(repaired.repair, holes, tint)))
    if failure is not None:
        add_warning(repaired.report, warning("no_close_ups", reason=failure))
        return
    for i, hole in enumerate(holes):
        if is_full():
            return
        progress("closeups", i / len(holes))
        _close_up(pairs[0], repaired, hole, save)


def _pair_around(repair: Repair, holes: list[Hole], tint: Tint) -> Pair:
    """Make a repair ready for pictures of some of its holes."""
    mesh, invented = repair.filled.mesh, invented_in(repair, tint)
    if len(mesh.triangles) > MOST_TRIANGLES:
        mesh, kept = thinned(mesh, [mesh.vertices[hole.loop] for hole in holes])
        invented = invented.of(kept)
    return filled_pair(mesh, invented)


def _close_up(pair: Pair, repaired: RepairedFile, hole: Hole, save: Callable[[int, bytes], None]) -> None:
    """Draw a hole and save the picture, or warn."""
    numbered = _numbered(pair, repaired.repair, hole)
    failure = failure_of(lambda: save(hole.id, draw_hole(pair, numbered)))
    if failure is not None:
        add_warning(repaired.report, warning("no_close_up", hole=hole.id, reason=failure))


def _numbered(pair: Pair, repair: Repair, hole: Hole) -> NumberedHole:
    """Look up the rim of a hole; of a bridge both rims, and from where most of its strip shows."""
    filled, bridge = repair.filled, repair.results[hole.id].bridge
    vertices = filled.mesh.vertices
    if bridge is None:
        return NumberedHole(hole.id, vertices[hole.loop])
    far_end = NumberedHole(bridge.holes[1].id, vertices[bridge.holes[1].loop])
    own = np.flatnonzero(filled.triangle_hole == repair.chosen.index(hole)) + filled.n_measured_triangles
    # A bridge that was refused has no strip.
    strip = part_of(filled.mesh, own)
    strip = strip.flipped() if pair.is_flipped else strip
    towards = most_seen_from(pair.scene, strip) if len(own) else None
    return NumberedHole(hole.id, vertices[hole.loop], far_end, towards)


@contextmanager
def _stage(report: dict[str, Any], name: str) -> Iterator[None]:
    """Add the seconds of what happens inside to a report."""
    start = time.perf_counter()
    yield
    seconds = round(time.perf_counter() - start, 4)
    report["stages"].append({"name": name, "seconds": seconds, "peak_memory_mib": peak_memory_mib()})
