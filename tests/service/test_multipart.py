import itertools
from collections.abc import AsyncIterator

import anyio
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from service.multipart import PartData, PartEnd, PartStart, read_parts
from service.problems import ProblemError

TYPE = "multipart/form-data; boundary=XX"
BODY = (
    b'--XX\r\nContent-Disposition: form-data; name="mesh"; filename="Sch\xc3\xa4del.ply"\r\n'
    b"Content-Type: model/ply\r\n\r\nply\r\n--X almost\r\n\r\n--XX\r\n"
    b'Content-Disposition: form-data; name="spec"\r\n\r\n{}\r\n--XX--\r\n'
)


def parts_of(body: bytes, cuts: list[int], content_type: str = TYPE) -> list[tuple[str, str | None, bytes]]:
    async def chunks() -> AsyncIterator[bytes]:
        edges = sorted({0, len(body), *(cut % (len(body) + 1) for cut in cuts)})
        for start, end in itertools.pairwise(edges):
            yield body[start:end]

    async def collect() -> list[tuple[str, str | None, bytes]]:
        found: list[tuple[str, str | None, bytes]] = []
        n_ended = 0
        async for event in read_parts(content_type, chunks()):
            if isinstance(event, PartStart):
                found.append((event.name, event.filename, b""))
            elif isinstance(event, PartData):
                name, filename, data = found.pop()
                found.append((name, filename, data + event.data))
            elif isinstance(event, PartEnd):
                n_ended += 1
        assert n_ended == len(found)
        return found

    return anyio.run(collect)


@settings(max_examples=40)
@given(cuts=st.lists(st.integers(0, 10_000), max_size=12))
def test_parts_come_out_the_same_however_the_body_is_cut(cuts: list[int]) -> None:
    assert parts_of(BODY, cuts) == [
        ("mesh", "Schädel.ply", b"ply\r\n--X almost\r\n"),
        ("spec", None, b"{}"),
    ]


@settings(max_examples=40)
@given(length=st.integers(0, len(BODY) - 5))
def test_a_body_that_ends_early_is_never_taken_for_whole(length: int) -> None:
    with pytest.raises(ProblemError) as caught:
        parts_of(BODY[:length], [])
    assert caught.value.code == "malformed_multipart"


@pytest.mark.parametrize(
    ("body", "content_type"),
    [
        (BODY, "multipart/form-data"),
        (BODY, "multipart/form-data; boundary=YY"),
        (BODY, f"multipart/form-data; boundary={'X' * 5000}"),
        (b"--XX\r\nContent-Type: model/ply\r\n\r\nply\r\n--XX--\r\n", TYPE),
        (b'--XX\r\nContent-Disposition: form-data; name="a"\r\n\r\n1\r\n' * 20 + b"--XX--\r\n", TYPE),
        (b'--XX\r\nContent-Disposition: form-data; name="' + b"a" * 100_000 + b'"\r\n\r\n1\r\n--XX--\r\n', TYPE),
    ],
)
def test_a_broken_body_is_refused(body: bytes, content_type: str) -> None:
    with pytest.raises(ProblemError) as caught:
        parts_of(body, [], content_type)
    assert caught.value.status == 400
