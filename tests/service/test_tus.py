"""Headers of the protocol tus; requests are tested in `tests/service/routes/test_uploads.py`, and by peers."""

import base64
import contextlib

import pytest
from hypothesis import given
from hypothesis import strategies as st
from starlette.testclient import TestClient

from service.problems import ProblemError
from service.tus import MAX_JOINED, Checksum, Metadata, read_joined, read_metadata

UPLOAD_ID = "upl_01jd7z3v5qk8m2x4c6b8n0a9de"
SHA256 = "ab" * 32


def field(**values: str) -> str:
    return ",".join(f"{key} {base64.b64encode(value.encode()).decode()}" for key, value in values.items())


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (None, Metadata(None, None, None)),
        ("", Metadata(None, None, None)),
        (field(filename="a.stl"), Metadata("a.stl", "stl", None)),
        (field(name="b.ply", filetype="model/stl"), Metadata("b.ply", "ply", None)),
        (field(name="b", filetype="model/stl"), Metadata("b", "stl", None)),
        (field(filename="a.stl", format="obj", sha256=SHA256.upper()), Metadata("a.stl", "obj", SHA256)),
        ("is_confidential,filename YS5wbHk=", Metadata("a.ply", "ply", None)),
    ],
)
def test_metadata_says_name_format_and_sha256(text: str | None, found: Metadata) -> None:
    assert read_metadata(text) == found


@given(st.text(st.characters(codec="latin-1"), max_size=100))
def test_no_metadata_is_worse_than_refused(text: str) -> None:
    with contextlib.suppress(ProblemError):
        name = read_metadata(text).filename
        assert name is None or name.isprintable()


def test_a_final_upload_names_paths_or_urls() -> None:
    path = f"/v1/uploads/{UPLOAD_ID}"
    assert read_joined(f"final;{path} https://a.example:1/v1/uploads/{UPLOAD_ID}") == (UPLOAD_ID, UPLOAD_ID)
    assert len(read_joined(f"final;{' '.join([path] * MAX_JOINED)}")) == MAX_JOINED
    for text in ("final;", "final;/v1/meshes/a", f"final;{path}x", f"final;{' '.join([path] * (MAX_JOINED + 1))}"):
        with pytest.raises(ProblemError):
            read_joined(text)


def test_a_checksum_fits_its_bytes_and_no_others() -> None:
    for data in (b"ab", b"a", b"abc", b""):
        checksum = Checksum("sha1 2iNhTgJGmg18e9G9q1ycR0sZBNw=")
        checksum.update(data)
        if data == b"ab":
            checksum.check()
        else:
            with pytest.raises(ProblemError) as caught:
                checksum.check()
            assert caught.value.status == 460


def test_every_answer_names_the_version(client: TestClient) -> None:
    for path in ("/v1/uploads", "/v1/uploads/none"):
        for method in ("GET", "PUT", "POST", "OPTIONS"):
            assert client.request(method, path).headers["tus-resumable"] == "1.0.0"
    assert "tus-resumable" not in client.get("/v1/uploadsx").headers
