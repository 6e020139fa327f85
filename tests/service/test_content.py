import hashlib

import pytest
from hypothesis import given
from hypothesis import strategies as st
from starlette.testclient import TestClient

from quadpatch_client.schema import TASKS
from service.content import content_disposition, result_name

DATA = bytes(range(256)) * 40


@pytest.fixture
def path(client: TestClient) -> str:
    mesh = client.post("/v1/meshes?filename=scan.ply", content=DATA).json()
    return str(mesh["links"]["content"])


def test_the_whole_comes_with_a_strong_tag_and_a_name(client: TestClient, path: str) -> None:
    answer = client.get(path)
    assert answer.content == DATA
    assert answer.headers["etag"] == f'"{hashlib.sha256(DATA).hexdigest()}"'
    assert answer.headers["accept-ranges"] == "bytes"
    assert answer.headers["content-disposition"] == 'attachment; filename="scan.ply"'


@pytest.mark.parametrize(
    ("header", "first", "last"),
    [
        ("bytes=0-0", 0, 0),
        ("bytes=10-19", 10, 19),
        ("bytes=10000-", 10000, 10239),
        ("bytes=-100", 10140, 10239),
        ("bytes=-99999", 0, 10239),
        ("bytes=10-99999", 10, 10239),
    ],
)
def test_a_range_gives_just_its_bytes(client: TestClient, path: str, header: str, first: int, last: int) -> None:
    answer = client.get(path, headers={"Range": header})
    assert answer.status_code == 206
    assert answer.content == DATA[first : last + 1]
    assert answer.headers["content-range"] == f"bytes {first}-{last}/{len(DATA)}"
    assert answer.headers["content-length"] == str(last - first + 1)


@pytest.mark.parametrize("header", ["bytes=10240-", "bytes=99999-100000", "bytes=-0"])
def test_a_range_behind_the_end_is_not_satisfiable(client: TestClient, path: str, header: str) -> None:
    answer = client.get(path, headers={"Range": header})
    assert answer.status_code == 416
    assert answer.headers["content-range"] == f"bytes */{len(DATA)}"
    assert answer.json()["code"] == "range_not_satisfiable"


@pytest.mark.parametrize("header", ["bytes=0-1,5-6", "lines=1-2", "bytes=5-2", "bytes=a-b", "bytes=-", "nonsense"])
def test_what_is_no_single_range_gets_the_whole(client: TestClient, path: str, header: str) -> None:
    answer = client.get(path, headers={"Range": header})
    assert answer.status_code == 200
    assert answer.content == DATA


def test_a_range_of_another_version_gets_the_whole(client: TestClient, path: str) -> None:
    etag = client.get(path).headers["etag"]
    assert client.get(path, headers={"Range": "bytes=0-1", "If-Range": etag}).status_code == 206
    assert client.get(path, headers={"Range": "bytes=0-1", "If-Range": '"other"'}).status_code == 200


def test_what_the_client_has_is_not_sent_again(client: TestClient, path: str) -> None:
    etag = client.get(path).headers["etag"]
    for header in (etag, f'"other", {etag}', f"W/{etag}", "*"):
        answer = client.get(path, headers={"If-None-Match": header})
        assert (answer.status_code, answer.content) == (304, b"")
    assert client.get(path, headers={"If-None-Match": '"other"'}).status_code == 200


@given(name=st.text(min_size=1, max_size=60).filter(lambda text: text.encode("utf-8", "ignore").decode() == text))
def test_no_name_breaks_out_of_its_header(name: str) -> None:
    header = content_disposition(name)
    assert header.isascii()
    assert not any(character in header for character in "\r\n\0\\")
    assert header.count('"') == 2


def test_a_name_in_another_script_is_whole_in_the_extended_parameter() -> None:
    assert (
        content_disposition("Schädel.ply") == "attachment; filename=\"Sch_del.ply\"; filename*=UTF-8''Sch%C3%A4del.ply"
    )


@pytest.mark.parametrize(
    ("filename", "expected"),
    [("scan.ply", "scan-repaired.stl"), ("a.b.ply", "a.b-repaired.stl"), (None, "mesh-ffffffffffff-repaired.stl")],
)
def test_a_result_is_named_after_its_upload(filename: str | None, expected: str) -> None:
    assert result_name(filename, "f" * 64, ".stl") == expected


def test_the_name_of_a_result_says_what_was_done() -> None:
    names = [result_name("scan.ply", "f" * 64, ".qpz", task) for task in TASKS]
    assert names == [
        f"scan-{word}.qpz" for word in ("repaired", "restored", "denoised", "encoded", "decoded", "learned")
    ]
