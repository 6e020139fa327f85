"""Numbers in a text that are replaced by others, with every other byte as it was.

Tested in `tests/quadpatch/formats/test_moving.py`.
"""

import numpy as np
from numpy.typing import NDArray

from quadpatch.formats.text import to_words, word_ends, word_starts
from quadpatch.types import BoolArray, FloatArray, IntArray


def words_from(text: bytes | NDArray[np.uint8], places: IntArray, count: int) -> tuple[IntArray, IntArray]:
    """Find the words that stand at some places of a text or behind them.

    Parameters
    ----------
    text : bytes or (n_bytes,) uint8
    places : (n,) int64
        Bytes at which the first word begins, or white space in front of it.
    count : int
        How many words to find behind each place; so many must be there.

    Returns
    -------
    starts, stops : (n, count) int64
        First byte of each word, and the byte behind it.
    """
    raw = np.frombuffer(text, np.uint8) if isinstance(text, bytes) else text
    starts, stops = word_starts(raw), word_ends(raw.tobytes())
    word = np.searchsorted(starts, places)[:, np.newaxis] + np.arange(count)
    return starts[word], stops[word]


def replace_numbers(
    text: bytes, spans: tuple[IntArray, IntArray], before: FloatArray, after: FloatArray, rows: BoolArray
) -> bytes:
    """Write other numbers into a text where they differ.

    Parameters
    ----------
    text : bytes
    spans : ((n, k) int64, (n, k) int64)
        First byte of each number, and the byte behind it.
    before, after : (n, k) float64
        What the text says, and what it is to say: in the fewest digits that read back as the same number.
    rows : (n,) bool
        Rows that are looked at; all others stay.
    """
    differs = (before != after) & rows[:, np.newaxis]
    return replace_words(text, spans[0][differs], spans[1][differs], to_words(after[differs]))


def replace_words(text: bytes, starts: IntArray, stops: IntArray, words: list[str]) -> bytes:
    """Put words in the place of stretches of a text.

    Parameters
    ----------
    text : bytes
    starts, stops : (n,) int64
        First byte of each stretch, and the byte behind it; stretches do not overlap, an empty one inserts.
    words : list of n str
    """
    pieces: list[bytes] = []
    at = 0
    order = np.lexsort([stops, starts])
    for start, stop, number in zip(starts[order].tolist(), stops[order].tolist(), order.tolist(), strict=True):
        pieces += [text[at:start], words[number].encode()]
        at = stop
    return b"".join([*pieces, text[at:]])
