import base64
import gzip
import hashlib
import random
import tracemalloc
from collections.abc import Callable

import pytest
from backports import zstd
from starlette.testclient import TestClient

from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from service.app import create_app
from service.content_coding import DECODERS, PIECE_BYTES
from service.problems import ProblemError

DATA = bytes(random.Random(7).choices(range(64), k=300_000))
CODERS: dict[str, Callable[[bytes], bytes]] = {"gzip": gzip.compress, "zstd": zstd.compress}
BOMB = 64 << 20


def decoded(coding: str, coded: bytes, chunk: int) -> bytes:
    decoder, pieces = DECODERS[coding](), []
    for start in range(0, len(coded), chunk):
        decoder.feed(coded[start : start + chunk])
        while piece := decoder.read():
            assert len(piece) <= PIECE_BYTES
            pieces.append(piece)
    decoder.finish()
    return b"".join(pieces)


def digest(data: bytes) -> str:
    return f"sha-256=:{base64.b64encode(hashlib.sha256(data).digest()).decode()}:"


@pytest.mark.parametrize("coding", CODERS)
@pytest.mark.parametrize("chunk", [1, 1000, 1 << 20])
def test_bytes_come_out_as_they_went_in_however_they_are_cut(coding: str, chunk: int) -> None:
    data = DATA[:3000] if chunk == 1 else DATA
    assert decoded(coding, CODERS[coding](data), chunk) == data


@pytest.mark.parametrize("coding", CODERS)
def test_members_and_frames_follow_each_other(coding: str) -> None:
    assert decoded(coding, CODERS[coding](b"ab") + CODERS[coding](b"cd"), 5) == b"abcd"


@pytest.mark.parametrize("coding", CODERS)
@pytest.mark.parametrize("spoil", [lambda coded: coded[:-3], lambda coded: coded + b"x", lambda _: b"no such thing"])
def test_what_is_cut_off_or_no_such_thing_is_refused(coding: str, spoil: Callable[[bytes], bytes]) -> None:
    with pytest.raises(ProblemError) as caught:
        decoded(coding, spoil(CODERS[coding](DATA)), 4096)
    assert caught.value.code == "malformed_encoding"


@pytest.mark.parametrize("coding", CODERS)
def test_a_bomb_takes_no_more_memory_than_a_piece(coding: str) -> None:
    coded = CODERS[coding](bytes(BOMB))
    assert len(coded) < 100_000
    decoder, size = DECODERS[coding](), 0
    tracemalloc.start()
    try:
        decoder.feed(coded)
        while piece := decoder.read():
            size += len(piece)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert size == BOMB
    assert peak < 8 * PIECE_BYTES


def test_a_zstd_window_larger_than_http_allows_is_refused() -> None:
    options: dict[int, int] = {
        zstd.CompressionParameter.window_log: 24,
        zstd.CompressionParameter.enable_long_distance_matching: 1,
    }
    coder = zstd.ZstdCompressor(options=options)
    with pytest.raises(ProblemError):
        decoded("zstd", coder.compress(DATA) + coder.flush(), 4096)


@pytest.mark.parametrize("coding", ["gzip", "zstd", "GZIP"])
def test_a_coded_mesh_is_stored_as_what_it_is(client: TestClient, coding: str) -> None:
    coded = CODERS[coding.lower()](DATA)
    stated = {"Content-Digest": digest(coded), "Repr-Digest": digest(coded), "Unencoded-Digest": digest(DATA)}
    answer = client.post("/v1/meshes", content=coded, headers={"Content-Encoding": coding, **stated})
    assert answer.status_code == 201, answer.text
    assert answer.json()["id"] == hashlib.sha256(DATA).hexdigest()
    assert answer.json()["size_bytes"] == len(DATA)


@pytest.mark.parametrize("header", ["Content-Digest", "Repr-Digest", "Unencoded-Digest"])
def test_a_digest_speaks_of_the_sent_bytes_or_of_the_decoded_ones(
    client: TestClient, store: ObjectStore, header: str
) -> None:
    coded = gzip.compress(DATA)
    wrong = digest(coded if header == "Unencoded-Digest" else DATA)
    answer = client.post("/v1/meshes", content=coded, headers={"Content-Encoding": "gzip", header: wrong})
    assert (answer.status_code, answer.json()["code"]) == (400, "digest_mismatch")
    assert list(store.keys("meshes")) == []


def test_a_coded_form_is_decoded_before_it_is_read(client: TestClient) -> None:
    form = b'--X\r\nContent-Disposition: form-data; name="file"; filename="a.stl"\r\n\r\n' + DATA + b"\r\n--X--\r\n"
    headers = {"Content-Type": "multipart/form-data; boundary=X", "Content-Encoding": "gzip"}
    answer = client.post("/v1/meshes", content=gzip.compress(form), headers=headers)
    assert (answer.status_code, answer.json()["format"]) == (201, "stl")


@pytest.mark.parametrize("coding", CODERS)
def test_the_limit_holds_for_what_comes_out(settings: Settings, store: ObjectStore, coding: str) -> None:
    app = create_app(settings.model_copy(update={"max_upload_mb": 1}))
    with TestClient(app, base_url="http://127.0.0.1") as client:
        headers = {"Content-Encoding": coding}
        answer = client.post("/v1/meshes", content=CODERS[coding](bytes((1 << 20) + 1)), headers=headers)
        assert (answer.status_code, answer.json()["code"]) == (413, "body_too_large")
        assert list(store.keys("meshes")) == []
        assert client.post("/v1/meshes", content=CODERS[coding](bytes(1 << 20)), headers=headers).status_code == 201


def test_a_body_that_is_not_in_its_coding_is_refused(client: TestClient, store: ObjectStore) -> None:
    answer = client.post("/v1/meshes", content=DATA, headers={"Content-Encoding": "gzip"})
    assert (answer.status_code, answer.json()["code"]) == (400, "malformed_encoding")
    assert list(store.keys("meshes")) == []
