"""The lines of a text file as arrays: which keyword each begins with, and the numbers of many lines in one go.

A mesh of a million vertices has three million lines; looking at them one by one in Python takes half a minute, these
few passes over the bytes one or two seconds.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from quadpatch.formats.text import is_space, parse_numbers, word_starts
from quadpatch.types import BoolArray, FloatArray, IntArray

_SPACE, _HASH = 32, 35
# Deeper indentation is looked at line by line.
_USUAL_INDENT = 16


@dataclass(frozen=True)
class Lines:
    """Lines of a text that are not empty.

    Attributes
    ----------
    raw : (n_bytes,) uint8
        The text; the byte behind each line is white space or the end.
    word_starts : (n_words,) int64
        First byte of every word of the text.
    starts, stops : (n,) int64
        Bytes from the first character that is no white space to the line end.
    """

    raw: NDArray[np.uint8]
    word_starts: IntArray
    starts: IntArray
    stops: IntArray

    def select(self, chosen: BoolArray | slice) -> "Lines":
        """Keep some of the lines."""
        return replace(self, starts=self.starts[chosen], stops=self.stops[chosen])

    def behind(self, n_bytes: int) -> "Lines":
        """Leave out the first bytes of each line."""
        return replace(self, starts=np.minimum(self.starts + n_bytes, self.stops))

    def begin_with(self, keyword: bytes) -> BoolArray:
        """Whether each line begins with a keyword followed by white space or nothing, (n,) bool."""
        result = self.stops - self.starts >= len(keyword)
        last = len(self.raw) - 1
        for offset, byte in enumerate(keyword):
            result &= self.raw[np.minimum(self.starts + offset, last)] == byte
        after = self.starts + len(keyword)
        return np.asarray(result & ((after >= self.stops) | is_space(self.raw[np.minimum(after, last)])))

    def text(self, line: int) -> bytes:
        """Return one line."""
        return bytes(self.raw[self.starts[line] : self.stops[line]].tobytes())

    def joined(self) -> bytes:
        """Return all lines with a line feed behind each."""
        lengths = self.stops - self.starts
        # Positive where a kept stretch begins, negative where it ends: the running sum marks the bytes to keep.
        edges = np.zeros(len(self.raw) + 1, dtype=np.int8)
        kept = lengths > 0
        edges[self.starts[kept]] = 1
        edges[self.stops[kept]] -= 1
        inside = np.cumsum(edges[:-1], dtype=np.int8).astype(bool)
        # The byte behind a line is its line end, or the end of the text.
        inside[self.stops[kept & (self.stops < len(self.raw))]] = True
        return bytes(self.raw[inside].tobytes())

    def word_counts(self) -> IntArray:
        """Count the words of each line, (n,) int64."""
        return np.searchsorted(self.word_starts, self.stops) - np.searchsorted(self.word_starts, self.starts)

    def numbers(self) -> FloatArray:
        """Parse all words of all lines as numbers, (n_words,) float64."""
        return parse_numbers(self.joined())


def split_lines(text: bytes, keep_comments_of: tuple[bytes, ...] = ()) -> Lines:
    """Find the lines of a text.

    Parameters
    ----------
    text : bytes
        Lines end in LF, CR LF or CR; from `#` to the line end is comment.
    keep_comments_of : tuple of bytes
        Keywords of lines in which `#` is a character like others.
    """
    raw = np.frombuffer(text, np.uint8)
    is_end = (raw == 10) | (raw == 13)
    bounds = np.flatnonzero(is_end).astype(np.int64)
    starts = np.concatenate([[0], bounds + 1]).astype(np.int64)
    stops = np.append(bounds, len(raw)).astype(np.int64)
    filled = stops > starts
    lines = _without_indent(Lines(raw, word_starts(raw), starts[filled], stops[filled]))
    if (raw == _HASH).any():
        lines = _without_comments(lines, keep_comments_of)
    return lines


def _without_indent(lines: Lines) -> Lines:
    """Move starts to the first character that is no white space, and drop blank lines."""
    starts = lines.starts.copy()
    indented = np.arange(len(starts))
    for _ in range(_USUAL_INDENT):
        at = starts[indented]
        more = (at < lines.stops[indented]) & is_space(lines.raw[np.minimum(at, len(lines.raw) - 1)])
        indented = indented[more]
        if len(indented) == 0:
            break
        starts[indented] += 1
    for line in indented.tolist():
        start, stop = int(starts[line]), int(lines.stops[line])
        starts[line] = stop - len(lines.raw[start:stop].tobytes().lstrip())
    filled = starts < lines.stops
    return replace(lines, starts=starts[filled], stops=lines.stops[filled])


def _without_comments(lines: Lines, keep_in: tuple[bytes, ...]) -> Lines:
    """End lines at their first `#`, and drop those that have nothing in front of it."""
    hashes = np.flatnonzero(lines.raw == _HASH)
    owner = np.searchsorted(lines.starts, hashes, side="right") - 1
    inside = (owner >= 0) & (hashes < lines.stops[np.maximum(owner, 0)])
    owner, first = np.unique(owner[inside], return_index=True)
    hashes = hashes[inside][first]
    kept = np.zeros(len(lines.starts), dtype=bool)
    for keyword in keep_in:
        kept |= lines.begin_with(keyword)
    cut = ~kept[owner]
    stops = lines.stops.copy()
    stops[owner[cut]] = hashes[cut]
    # The byte behind a line separates it from the next one.
    raw = lines.raw.copy()
    raw[hashes[cut]] = _SPACE
    filled = stops > lines.starts
    return replace(lines, raw=raw, starts=lines.starts[filled], stops=stops[filled])
