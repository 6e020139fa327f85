"""Untrusted text: file names, model cards, paths and headers end up in messages, logs and rows.

Line breaks forge lines of logs, control characters steer terminals, and lone surrogates are in no encoding: a row that
holds one can't be sent in an answer.
"""

from typing import Any

LONGEST_MESSAGE = 500
_REPLACEMENT = "\ufffd"


def printable(text: str, longest: int = LONGEST_MESSAGE) -> str:
    """Escape what is no printable character, and cut what is longer than `longest`."""
    if not text.isprintable():
        text = "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text[:longest])
    return text if len(text) <= longest else text[: longest - 1] + "…"


def encodable(value: Any) -> Any:
    """Return nested JSON values with every lone surrogate replaced by U+FFFD; the rest stays as it is."""
    if isinstance(value, str):
        return value if not has_surrogate(value) else "".join(map(_without_surrogate, value))
    if isinstance(value, dict):
        return {encodable(name): encodable(item) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [encodable(item) for item in value]
    return value


def has_surrogate(text: str) -> bool:
    """Return whether a text holds a lone surrogate, and so has no encoding."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return True
    return False


def _without_surrogate(character: str) -> str:
    return _REPLACEMENT if "\ud800" <= character <= "\udfff" else character
