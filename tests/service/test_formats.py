import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch_client.schema import Format
from service.formats import clean_filename, stated_format


@pytest.mark.parametrize(
    ("given_format", "filename", "media_type", "expected"),
    [
        ("stl", "scan.ply", "model/obj", "stl"),
        (None, "scan.PLY", "model/obj", "ply"),
        (None, "scan", "model/obj", "obj"),
        (None, "scan.xyz", "model/gltf-binary", "glb"),
        (None, "scan.xyz", "", None),
        (None, None, "application/octet-stream", None),
    ],
)
def test_what_is_stated_first_wins(
    given_format: Format | None, filename: str | None, media_type: str, expected: str | None
) -> None:
    assert stated_format(given_format, filename, media_type) == expected


@pytest.mark.parametrize(
    ("sent", "kept"),
    [
        ("scan.ply", "scan.ply"),
        ("/etc/passwd", "passwd"),
        ("C:\\scans\\part 7.stl", "part 7.stl"),
        ("a\0b\n.ply", "ab.ply"),
        ("folder/", None),
        ("", None),
        (None, None),
    ],
)
def test_of_a_path_only_the_name_is_kept(sent: str | None, kept: str | None) -> None:
    assert clean_filename(sent) == kept


@given(st.text())
def test_a_kept_name_fits_its_column_and_every_database(sent: str) -> None:
    kept = clean_filename(sent)
    if kept is not None:
        assert 0 < len(kept) <= 255
        assert "\0" not in kept
        kept.encode()
