"""Lines of a text as arrays."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.formats.lines import split_lines

PIECES = ["v 1 2", "f", " ", "\t", "\n", "\r\n", "\r", "# x", "#", "vt 3", "usemtl a#b", "4.5", "v", "\x0b", "end"]


def expected(text: str) -> list[bytes]:
    """What a loop over lines gives."""
    found = []
    for line in text.replace("\r", "\n").split("\n"):
        bare = line.strip(" \t\v\f")
        if not bare.startswith("usemtl") or bare[6:7] not in (" ", "\t", "\v", "\f", ""):
            bare = bare.split("#")[0]
        if bare.strip(" \t\v\f"):
            found.append(bare.encode())
    return found


@given(st.lists(st.sampled_from(PIECES), max_size=30).map("".join))
def test_lines_words_and_keywords_are_what_a_loop_would_give(text: str) -> None:
    lines = split_lines(text.encode(), keep_comments_of=(b"usemtl",))
    wanted = expected(text)
    assert [lines.text(i).rstrip() for i in range(len(lines.starts))] == [line.rstrip() for line in wanted]
    assert lines.word_counts().tolist() == [len(line.split()) for line in wanted]
    assert lines.begin_with(b"v").tolist() == [line.split()[0] == b"v" for line in wanted]
    assert lines.joined().split() == b" ".join(wanted).split()
    assert lines.behind(1).joined().split() == b" ".join(line[1:] for line in wanted).split()


def test_numbers_of_chosen_lines_come_in_one_array() -> None:
    lines = split_lines(b"v 1 2 3\nf 7\n v -4 5e-1 6 # and 7\nv\t8 9 10")
    chosen = lines.select(lines.begin_with(b"v")).behind(1)
    assert chosen.numbers().tolist() == [1, 2, 3, -4, 0.5, 6, 8, 9, 10]
    assert chosen.word_counts().tolist() == [3, 3, 3]


def test_an_empty_text_has_no_lines() -> None:
    lines = split_lines(b"")
    assert len(lines.starts) == 0
    assert lines.word_counts().dtype == np.int64
    assert lines.joined() == b""
