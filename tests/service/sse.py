"""Server-sent events as a browser reads them: an event counts once its blank line is there."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass


@dataclass(frozen=True)
class SentEvent:
    id: int
    type: str
    data: str


def sent_events(lines: Iterable[str]) -> Iterator[SentEvent]:
    fields: dict[str, str] = {}
    for line in lines:
        if line:
            name, _, value = line.partition(":")
            fields[name] = value.removeprefix(" ")
            continue
        if "data" in fields:
            yield SentEvent(int(fields["id"]), fields["event"], fields["data"])
        fields = {}
