"""Text as mesh files hold it: encodings, numbers, lines."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadpatch.errors import ReadError
from quadpatch.types import BoolArray, FloatArray, IntArray

# Byte order mark, codec of the text behind it.
_MARKS = (
    (b"\xff\xfe\x00\x00", "utf-32-le"),
    (b"\x00\x00\xfe\xff", "utf-32-be"),
    (b"\xff\xfe", "utf-16-le"),
    (b"\xfe\xff", "utf-16-be"),
    (b"\xef\xbb\xbf", "utf-8"),
)


def decode_text(data: bytes) -> tuple[bytes, str]:
    """Bring a text file to bytes with one byte for each ASCII character.

    Parameters
    ----------
    data : bytes
        The file; encodings other than UTF-8 and its kin are told by their byte order mark.

    Returns
    -------
    text : bytes
        UTF-8 without a mark; names in an older 8-bit encoding stay as they are.
    codec : str
        What text appended to the file has to be encoded in.

    Raises
    ------
    ReadError
        If the text is not in the encoding that its mark names.
    """
    for mark, codec in _MARKS:
        if data.startswith(mark):
            if codec == "utf-8":
                return data[len(mark) :], codec
            try:
                return data[len(mark) :].decode(codec).encode(), codec
            except UnicodeDecodeError as error:
                raise ReadError(f"the file begins as {codec} but is not: {error.reason}") from error
    return data, "utf-8"


def encode_like(data: bytes, text: bytes, codec: str) -> bytes:
    """Bring text back to the encoding of the file that `decode_text` took it from, with the mark that it had.

    Parameters
    ----------
    data : bytes
        The file as it was, or its beginning.
    text : bytes
        What it is to hold.
    codec : str
        As `decode_text` named it.
    """
    mark = next((mark for mark, _ in _MARKS if data.startswith(mark)), b"")
    return mark + (text if codec == "utf-8" else text.decode().encode(codec))


def line_end_of(text: bytes) -> str:
    """Line end that a text uses, seen from its first line."""
    first = text.find(b"\n")
    if first < 0:
        return "\r" if b"\r" in text else "\n"
    return "\r\n" if text[first - 1 : first] == b"\r" else "\n"


def parse_numbers(text: bytes) -> FloatArray:
    """Turn white-space separated decimal numbers into float64.

    Parameters
    ----------
    text : bytes

    Raises
    ------
    ReadError
        Naming the first word that is no number.
    """
    if not text.strip():
        return np.zeros(0)
    try:
        numbers = np.fromstring(text, dtype=np.float64, sep=" ")
    except ValueError as error:
        raise ReadError(f"{_first_bad_word(text)!r} is no number") from error
    # `1-2` is one word to every reader and two numbers to this one.
    if len(numbers) != count_words(text):
        raise ReadError(f"{_first_bad_word(text)!r} is no number")
    return numbers


def _first_bad_word(text: bytes) -> str:
    for word in text.split():
        try:
            float(word)
        except ValueError:
            return word[:40].decode("latin-1")
    return ""


def parse_integers(text: bytes, what: str) -> IntArray:
    """Turn white-space separated whole numbers into int64.

    Raises
    ------
    ReadError
        For words that are no whole number or beyond 2**53.
    """
    return to_integers(parse_numbers(text), what)


def to_integers(numbers: FloatArray, what: str) -> IntArray:
    """Cast numbers that must be whole ones to int64.

    Raises
    ------
    ReadError
        For numbers that are no whole number or beyond 2**53.
    """
    whole = (np.abs(numbers) <= 2.0**53) & (numbers == np.trunc(numbers))
    if not whole.all():
        raise ReadError(f"{what}: {float(numbers[np.argmin(whole)]):g} is no whole number")
    return numbers.astype(np.int64)


def is_space(raw: NDArray[np.uint8]) -> BoolArray:
    """Whether bytes are white space as bytes.split() sees it: 9 to 13, which has all line ends, and 32."""
    return np.asarray((raw == 32) | ((raw >= 9) & (raw <= 13)))


def word_starts(raw: NDArray[np.uint8]) -> IntArray:
    """Find the first byte of each white-space separated word, (n_words,) int64."""
    inside = ~is_space(raw)
    begins = inside.copy()
    begins[1:] &= ~inside[:-1]
    return np.flatnonzero(begins).astype(np.int64)


def count_words(text: bytes) -> int:
    """Count white-space separated words."""
    inside = ~is_space(np.frombuffer(text, np.uint8))
    return int(inside[0]) + int((inside[1:] & ~inside[:-1]).sum()) if len(inside) else 0


def word_ends(text: bytes) -> IntArray:
    """Find the byte behind each white-space separated word, (n_words,) int64."""
    raw = np.frombuffer(text, np.uint8)
    blank = is_space(raw)
    ends = np.flatnonzero(~blank[:-1] & blank[1:]) + 1
    if len(raw) and not blank[-1]:
        ends = np.append(ends, len(raw))
    return ends.astype(np.int64)


def to_words(values: NDArray[Any]) -> list[str]:
    """Shortest decimal words that read back as the same numbers of the same type."""
    if values.dtype == np.float32:
        return [str(word) for word in values.astype(str).tolist()]
    return list(map(repr, values.tolist()))


def to_lines(keyword: str, table: NDArray[Any], line_end: str) -> str:
    """Write one line for each row: the keyword, and the row's float64 or int64 numbers as `to_words` does."""
    words = [*([keyword] if keyword else []), *["%r"] * table.shape[1]]
    # One formatting of the whole text is three times faster than one for each row.
    return (" ".join(words) + line_end) * len(table) % tuple(table.ravel().tolist())
