"""Numbers and encodings of text."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.errors import ReadError
from quadpatch.formats.text import (
    decode_text,
    line_end_of,
    parse_integers,
    parse_numbers,
    to_lines,
    to_words,
    word_ends,
    word_starts,
)


@given(st.lists(st.floats(allow_nan=False)))
def test_float64_words_read_back_to_the_bit(values: list[float]) -> None:
    array = np.array(values, dtype=np.float64)
    assert parse_numbers(" ".join(to_words(array)).encode()).tobytes() == array.tobytes()


@given(st.lists(st.floats(width=32, allow_nan=False)))
def test_float32_words_read_back_to_the_bit_and_are_short(values: list[float]) -> None:
    array = np.array(values, dtype=np.float32)
    words = to_words(array)
    assert parse_numbers(" ".join(words).encode()).astype(np.float32).tobytes() == array.tobytes()
    assert all(len(word) <= 15 for word in words)


@pytest.mark.parametrize("text", [b"1 2 x", b"1,2", b"0x10", b"1-2", b"1 2\0", b"--1", b"1e", b"1_0"])
def test_words_that_are_no_numbers_are_refused(text: bytes) -> None:
    with pytest.raises(ReadError):
        parse_numbers(text)


@pytest.mark.parametrize("text", [b"1.5", b"1e30", b"inf", b"nan"])
def test_integers_must_be_whole_and_exact(text: bytes) -> None:
    with pytest.raises(ReadError):
        parse_integers(text, "test")


@given(st.text("ab \t\n\r\v\f"))
def test_word_bounds_are_those_of_split(text: str) -> None:
    data = text.encode()
    starts, ends = word_starts(np.frombuffer(data, np.uint8)), word_ends(data)
    assert [data[a:b] for a, b in zip(starts, ends, strict=True)] == data.split()


@given(
    text=st.text(st.characters(exclude_categories=["Cs", "Cc"])), kind=st.sampled_from(["8", "16-le", "16-be", "32-le"])
)
def test_marked_text_is_decoded_from_every_encoding(text: str, kind: str) -> None:
    codec = f"utf-{kind}"
    assert decode_text(("\ufeff" + text).encode(codec)) == (text.encode(), codec)


def test_unmarked_bytes_stay_as_they_are() -> None:
    assert decode_text(b"g Gr\xf6\xdfe") == (b"g Gr\xf6\xdfe", "utf-8")


@pytest.mark.parametrize(("text", "end"), [(b"a\nb\r\n", "\n"), (b"a\r\nb\n", "\r\n"), (b"a\rb\r", "\r"), (b"a", "\n")])
def test_the_first_line_tells_the_line_end(text: bytes, end: str) -> None:
    assert line_end_of(text) == end


def test_lines_have_a_keyword_and_the_rows_numbers() -> None:
    assert to_lines("v", np.array([[1.0, 0.1], [2, 1e-7]]), "\r\n") == "v 1.0 0.1\r\nv 2.0 1e-07\r\n"
    assert to_lines("", np.array([[1, 2]]), "\n") == "1 2\n"
