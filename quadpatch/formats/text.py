"""Text as mesh files hold it: encodings, numbers, lines."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadpatch.errors import ReadError
from quadpatch.types import FloatArray, IntArray

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
        return np.fromstring(text, dtype=np.float64, sep=" ")
    except (ValueError, DeprecationWarning) as error:
        raise ReadError(f"{_first_bad_word(text)!r} is no number") from error


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
    numbers = parse_numbers(text)
    whole = (np.abs(numbers) <= 2.0**53) & (numbers == np.trunc(numbers))
    if not whole.all():
        raise ReadError(f"{what}: {float(numbers[np.argmin(whole)]):g} is no whole number")
    return numbers.astype(np.int64)


def word_ends(text: bytes) -> IntArray:
    """Find the byte behind each white-space separated word, (n_words,) int64."""
    raw = np.frombuffer(text, np.uint8)
    # White space as bytes.split() sees it: tab, line feed, vertical tab, form feed, carriage return, space.
    is_space = (raw == 32) | ((raw >= 9) & (raw <= 13))
    ends = np.flatnonzero(~is_space[:-1] & is_space[1:]) + 1
    if len(raw) and not is_space[-1]:
        ends = np.append(ends, len(raw))
    return ends.astype(np.int64)


def to_words(values: NDArray[Any]) -> list[str]:
    """Shortest decimal words that read back as the same numbers of the same type."""
    return [str(value) for value in values.astype(str)]


def to_lines(keyword: str, table: NDArray[Any], line_end: str) -> str:
    """One line for each row: the keyword and the row's numbers as `to_words` writes them."""
    columns = [to_words(column) for column in table.T]
    start = f"{keyword} " if keyword else ""
    return "".join(start + " ".join(row) + line_end for row in zip(*columns, strict=True))
