"""Pictures are optional: the mesh and the report are there whatever becomes of them."""

import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from quadpatch.preview import drawing
from quadpatch.preview.drawing import add_close_up_archive, add_close_ups, add_picture
from quadpatch.preview.hole_pictures import NumberedHole
from quadpatch.repair import RepairedFile, repair_and_keep
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import joined, punched, sphere, write_ply
from tests.quadpatch.test_repair import write_stl

HOLES = ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0))


def repaired(folder: Path, mesh: TriangleMesh, suffix: str = ".ply") -> RepairedFile:
    return repair_and_keep(write_ply(folder / "in.ply", mesh), folder / f"out{suffix}", "smooth")


@pytest.fixture(scope="module")
def ball(tmp_path_factory: pytest.TempPathFactory) -> RepairedFile:
    return repaired(tmp_path_factory.mktemp("ball"), punched(sphere(3), *HOLES, radius=0.3))


def pixels(path: Path) -> np.ndarray[Any, np.dtype[np.uint8]]:
    with Image.open(path) as image:
        assert image.format == "PNG"
        return np.asarray(image)


@pytest.mark.slow
def test_an_stl_of_which_each_facet_is_a_small_part_gets_its_picture(tmp_path: Path) -> None:
    """Its facets share no vertices, so that each looks like a piece of its own."""
    source = write_stl(tmp_path / "in.stl", punched(sphere(4), HOLES[0], radius=0.3))
    done = repair_and_keep(source, tmp_path / "out.stl", "smooth")
    add_picture(done, tmp_path / "out.png")
    assert done.report["warnings"] == []
    assert len(np.unique(pixels(tmp_path / "out.png").reshape(-1, 3), axis=0)) > 100


def test_a_conversion_to_stl_gets_its_picture(tmp_path: Path) -> None:
    done = repaired(tmp_path, punched(sphere(4), HOLES[0], radius=0.3), ".stl")
    add_picture(done, tmp_path / "out.png")
    assert done.report["warnings"] == []
    assert (tmp_path / "out.png").exists()


def balls(count: int, radius: float = 0.3) -> TriangleMesh:
    """So many equal balls in a row, each with a hole."""
    ball = punched(sphere(1), (0.0, 0.0, 1.0), radius=0.1)
    return joined(*(TriangleMesh(radius * ball.vertices + [i, 0.0, 0.0], ball.triangles) for i in range(count)))


@pytest.mark.parametrize("radius", [0.3, 1e-7])
def test_more_than_a_hundred_equal_pieces_get_their_picture(tmp_path: Path, radius: float) -> None:
    done = repaired(tmp_path, balls(120, radius))
    add_picture(done, tmp_path / "out.png")
    assert done.report["warnings"] == []
    assert (tmp_path / "out.png").exists()


def test_the_stage_of_a_picture_has_its_seconds(ball: RepairedFile, tmp_path: Path) -> None:
    add_picture(ball, tmp_path / "out.png")
    last = ball.report["stages"][-1]
    assert last["name"] == "preview"
    assert last["seconds"] > 0


@pytest.mark.parametrize("error", [ValueError("secret"), MemoryError(), ZeroDivisionError(), OSError(28, "disk full")])
def test_whatever_drawing_raises_is_a_warning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(drawing, "render_before_after", fail)
    monkeypatch.setattr(drawing, "draw_hole", fail)
    done = repaired(tmp_path, punched(sphere(3), HOLES[0], radius=0.3))
    add_picture(done, tmp_path / "out.png")
    add_close_ups(done, tmp_path / "closeups")
    picture, close_up = done.report["warnings"]
    assert picture.startswith("there is no picture: ")
    assert close_up.startswith("there is no close-up of hole 0: ")
    assert "secret" not in picture + close_up
    assert not (tmp_path / "out.png").exists()
    assert list((tmp_path / "closeups").iterdir()) == []
    add_close_up_archive(done, tmp_path / "closeups.zip")
    assert done.report["warnings"][2:] == [close_up]
    assert not (tmp_path / "closeups.zip").exists()


def test_a_folder_that_can_not_be_made_is_one_warning(ball: RepairedFile, tmp_path: Path) -> None:
    (tmp_path / "closeups").write_text("a file")
    before = list(ball.report["warnings"])
    add_close_ups(ball, tmp_path / "closeups")
    added = ball.report["warnings"][len(before) :]
    assert added == ["there are no close-ups: File exists"]


def test_every_chosen_hole_gets_a_close_up_named_by_its_id(ball: RepairedFile, tmp_path: Path) -> None:
    add_close_ups(ball, tmp_path / "new" / "folder")
    ids = [hole.id for hole in ball.repair.chosen]
    assert len(ids) == 2
    assert {path.name for path in (tmp_path / "new" / "folder").iterdir()} == {f"hole_{i}.png" for i in ids}


def test_an_archive_holds_what_the_folder_holds_the_widest_hole_first(tmp_path: Path) -> None:
    """Byte for byte, in each run."""
    holes = punched(punched(sphere(3), HOLES[0], radius=0.2), HOLES[1], (0.0, 1.0, 0.0), radius=0.3)
    done = repaired(tmp_path, holes)
    seen: list[tuple[str, float]] = []
    add_close_up_archive(done, tmp_path / "one.zip", lambda stage, fraction: seen.append((stage, fraction)))
    add_close_up_archive(done, tmp_path / "two.zip")
    assert (tmp_path / "one.zip").read_bytes() == (tmp_path / "two.zip").read_bytes()
    add_close_ups(done, tmp_path / "folder")
    widest_first = sorted(done.repair.chosen, key=lambda hole: -hole.diameter)
    with zipfile.ZipFile(tmp_path / "one.zip") as pack:
        assert pack.testzip() is None
        assert pack.namelist() == [f"hole_{hole.id}.png" for hole in widest_first]
        for name in pack.namelist():
            assert pack.read(name) == (tmp_path / "folder" / name).read_bytes()
    assert seen == [("closeups", i / 3) for i in range(3)]
    assert done.report["warnings"] == []
    assert [stage["name"] for stage in done.report["stages"]][-3:] == ["closeups"] * 3


def test_an_archive_is_bounded_in_number_and_in_size_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    done = repaired(tmp_path, balls(5))
    add_close_up_archive(done, tmp_path / "few.zip", most=2)
    assert done.report["warnings"] == ["close-ups show 2 of 5 holes, the widest"]
    drawn: list[int] = []

    def draw(_: object, hole: NumberedHole) -> bytes:
        drawn.append(hole.id)
        return bytes(1000)

    monkeypatch.setattr(drawing, "draw_hole", draw)
    monkeypatch.setattr(drawing, "MOST_CLOSE_UP_BYTES", 3500)
    add_close_up_archive(done, tmp_path / "small.zip")
    assert done.report["warnings"][1:] == ["close-ups show 3 of 5 holes, the widest"]
    assert len(drawn) == 4
    for name, count in (("few.zip", 2), ("small.zip", 3)):
        with zipfile.ZipFile(tmp_path / name) as pack:
            assert len(pack.namelist()) == count


def test_an_archive_of_no_chosen_hole_is_empty_and_no_warning(ball: RepairedFile, tmp_path: Path) -> None:
    nothing = RepairedFile({"warnings": [], "stages": []}, replace(ball.repair, chosen=[]))
    add_close_up_archive(nothing, tmp_path / "none.zip")
    assert nothing.report["warnings"] == []
    with zipfile.ZipFile(tmp_path / "none.zip") as pack:
        assert pack.namelist() == []
