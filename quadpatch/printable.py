"""Text that is safe to print: words of a hostile file end up in messages, logs, terminals and answers over HTTP."""

LONGEST = 500


def printable(text: str) -> str:
    """Escape what is no printable character, and cut what is too long.

    Line breaks forge lines of logs, control characters steer terminals, and lone surrogates are in no encoding.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
        In one line, at most `LONGEST` characters.
    """
    if not text.isprintable():
        text = "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text[:LONGEST])
    return text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"
