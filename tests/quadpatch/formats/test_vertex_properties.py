from pathlib import Path

import numpy as np
import pytest

from quadpatch.errors import OptionError
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.moving import Moved, write_moved
from quadpatch.formats.reading import read_bytes, read_scan
from quadpatch.formats.vertex_properties import vertex_mask, vertex_property
from tests.quadpatch.formats.test_moving import TEXTS, file_of


@pytest.mark.parametrize("kind", [np.uint8, np.int32, np.float32])
def test_a_property_that_was_written_is_found_by_its_name(kind: type[np.generic], tmp_path: Path) -> None:
    scan = read_scan(file_of("ply", tmp_path))
    values = (np.arange(len(scan.vertices)) % 3).astype(kind)
    write_moved(tmp_path / "out.ply", scan, Moved(scan.vertices, {"missing": values}))
    again = read_scan(tmp_path / "out.ply")
    found = vertex_property(again, "missing")
    assert found.dtype == values.dtype
    assert found.tobytes() == values.tobytes()
    assert vertex_mask(again, "missing").tolist() == (values != 0).tolist()


def test_nan_is_no_mark(tmp_path: Path) -> None:
    scan = read_scan(file_of("ply", tmp_path))
    values = np.full(len(scan.vertices), np.nan, np.float32)
    values[3] = 0.5
    write_moved(tmp_path / "out.ply", scan, Moved(scan.vertices, {"missing": values}))
    assert np.flatnonzero(vertex_mask(read_scan(tmp_path / "out.ply"), "missing")).tolist() == [3]


def test_a_name_that_is_not_there_is_answered_by_those_that_are() -> None:
    with pytest.raises(OptionError, match=r"no vertex property 'missing'; it has x, red, y, z$"):
        vertex_mask(read_bytes(TEXTS["ply"].encode(), "ply", ReadLimits()), "missing")


def test_other_formats_have_no_names() -> None:
    scan = read_bytes(TEXTS["obj"].encode(), "obj", ReadLimits())
    with pytest.raises(OptionError, match="in PLY files only; this one is obj"):
        vertex_property(scan, "missing")
