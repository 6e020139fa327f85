"""One way of logging for all processes: a line of text for a terminal, or one JSON object a line for machines.

What a line is about (the request, the job, the attempt) is kept in the context, so that code below need not
know it. Threads start with an empty context: one that works for a job is given a copy of the context that starts it.
"""

import json
import logging
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from datetime import UTC, datetime
from types import MappingProxyType
from typing import TextIO

from jobkit.settings import Settings
from quadpatch_rules.text import printable

# In the order in which they stand in a line.
FIELDS = ("request_id", "job_id", "mesh_id", "model", "view", "attempt", "worker")
_LONGEST_MESSAGE = 4000
_LONGEST_TRACEBACK = 20_000
_TEXT = "%(asctime)s %(levelname)s %(name)s: %(message)s"
_NOTHING: Mapping[str, object] = MappingProxyType({})
_SUBJECT: ContextVar[Mapping[str, object]] = ContextVar("subject of log lines", default=_NOTHING)
# They have handlers of their own by default.
_FOREIGN = ("uvicorn", "uvicorn.access", "uvicorn.error", "rq.worker", "rq.job")


def set_up_logs(settings: Settings, stream: TextIO | None = None) -> None:
    """Make all loggers of this process write to one stream.

    Parameters
    ----------
    settings : Settings
        `log_format` and `log_level`.
    stream : text file, optional
        Standard error unless given.
    """
    handler = logging.StreamHandler(stream or sys.stderr)
    handler.addFilter(_add_subject)
    handler.setFormatter(JsonFormatter() if settings.log_format == "json" else TextFormatter())
    logging.basicConfig(level=settings.log_level.upper(), handlers=[handler], force=True)
    for name in _FOREIGN:
        logger = logging.getLogger(name)
        logger.handlers.clear()
        logger.propagate = True


@contextmanager
def log_about(**fields: object) -> Iterator[None]:
    """Say in every line within a `with` block what it is about; fields that are None are left out."""
    unknown = fields.keys() - set(FIELDS)
    if unknown:
        raise ValueError(f"{', '.join(sorted(unknown))}: no fields of a log line")
    known = {name: value for name, value in fields.items() if value is not None}
    token = _SUBJECT.set({**_SUBJECT.get(), **known})
    try:
        yield
    finally:
        _SUBJECT.reset(token)


def current_request_id() -> str | None:
    """Return the id of the request at work, None outside of one."""
    value = _SUBJECT.get().get("request_id")
    return None if value is None else str(value)


class JsonFormatter(logging.Formatter):
    """One JSON object a line: time, level, logger, message, what it is about, and a traceback if there is one."""

    def format(self, record: logging.LogRecord) -> str:
        """Write a record."""
        values: dict[str, object] = {
            "time": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": _cut(record.getMessage(), _LONGEST_MESSAGE),
            **_subject_of(record),
        }
        if record.exc_info:
            values["traceback"] = _cut(self.formatException(record.exc_info), _LONGEST_TRACEBACK)
        if record.stack_info:
            values["stack"] = self.formatStack(record.stack_info)
        # In ASCII: no encoding of a terminal or a file refuses it, and no control character reaches either.
        return json.dumps(values, default=str)


class TextFormatter(logging.Formatter):
    """A line for people, with what it is about at the end of its message."""

    def __init__(self) -> None:
        super().__init__(_TEXT)

    def formatMessage(self, record: logging.LogRecord) -> str:  # noqa: N802 - the name is logging's
        """Write the line before a traceback."""
        about = " ".join(f"{name}={value}" for name, value in _subject_of(record).items())
        record.message = printable(record.message.rstrip("\n"), _LONGEST_MESSAGE)
        return super().formatMessage(record) + (f" [{about}]" if about else "")

    def formatException(self, ei: object) -> str:  # noqa: N802 - the name is logging's
        """Write a traceback, indented: text of a file in it can't look like a line of the log."""
        lines = super().formatException(ei).split("\n")  # type: ignore[arg-type]
        return "\n".join(f"    {printable(line, _LONGEST_MESSAGE)}" for line in lines)


def _cut(text: str, longest: int) -> str:
    """Leave out the middle: what was raised stands at the end."""
    return text if len(text) <= longest else f"{text[: longest // 2]}…{text[-longest // 2 :]}"


def _add_subject(record: logging.LogRecord) -> bool:
    """Note in the record what it is about, in the thread that logs."""
    record.subject = _SUBJECT.get()
    return True


def _subject_of(record: logging.LogRecord) -> dict[str, object]:
    subject: Mapping[str, object] = getattr(record, "subject", _NOTHING)
    return {name: subject[name] for name in FIELDS if name in subject}
