import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.errors import QuadpatchError, ReadError
from quadpatch_rules.text import LONGEST_MESSAGE, printable


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a scan of 3 × 4 mm, größe", "a scan of 3 × 4 mm, größe"),
        ("one\n2026 INFO forged", "one\\n2026 INFO forged"),
        ("\x1b[1mbold", "\\x1b[1mbold"),
        ("\ud800", "\\ud800"),
        ("\u2028\u202e\0", "\\u2028\\u202e\\x00"),
    ],
)
def test_what_can_not_be_printed_is_escaped(text: str, expected: str) -> None:
    assert printable(text) == expected
    assert str(ReadError(text)) == expected


@given(st.text(st.characters(categories=["L", "Cc", "Cs", "Zl", "Cf"])))
def test_messages_of_errors_are_one_line_in_every_encoding_of_unicode(text: str) -> None:
    message = str(QuadpatchError(text * 3))
    message.encode("utf-8")
    assert message.isprintable()
    assert len(message) <= 12 * LONGEST_MESSAGE


def test_long_messages_are_cut() -> None:
    assert len(printable("x" * 10_000)) == LONGEST_MESSAGE
    assert len(printable("\n" * 10_000)) == LONGEST_MESSAGE
