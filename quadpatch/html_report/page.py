"""From a report to its page. The page shows what stands in the report, and nothing else.

Repairs and the other tasks share a template; each has parts of its own.

It runs no script and loads nothing: its policy allows its own style sheet and pictures in the file itself. Jinja2
escapes every text, whatever it holds.
"""

import base64
import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from typing import Any

from jinja2 import Environment, FunctionLoader, StrictUndefined

from quadpatch.html_report import histogram, task_words, words
from quadpatch.html_report.in_short import in_short, invented_area
from quadpatch_rules.tasks import FILL

# A table of more rows is cut short, on the screen and on paper; the JSON inside the page has all holes.
MOST_ROWS = 10_000
MOST_PRINTED_ROWS = 400
_TEMPLATE, _TEMPLATE_OF_TASKS = "report.html.jinja", "task.html.jinja"


@dataclass(frozen=True)
class Pictures:
    """PNG files for a page: the whole before and after, and close-ups by the ids of their holes."""

    overview: bytes | None = None
    close_ups: Mapping[int, bytes] = field(default_factory=dict)


def render_page(report: Mapping[str, Any], pictures: Pictures | None = None) -> str:
    """Write a report that has a `provenance` as a page.

    Parameters
    ----------
    report : mapping
        Of a repair or another task, JSON-ready.
    pictures : Pictures, optional

    Returns
    -------
    str
        An HTML document, with the report as JSON inside.
    """
    pictures = pictures or Pictures()
    style = _text("style.css")
    common = {
        "report": report,
        "title": task_words.TITLES[report["task"]],
        "style": style,
        "style_hash": base64.b64encode(hashlib.sha256(style.encode()).digest()).decode(),
        "overview": _data_url(pictures.overview) if pictures.overview else None,
        "json": json.dumps(report, indent=1),
    }
    if report["task"] != FILL:
        own = {"in_short": task_words.task_in_short(report), "figures": task_words.figures(report)}
        return _environment().get_template(_TEMPLATE_OF_TASKS).render(common | own)
    own = {
        "in_short": in_short(report),
        "close_ups": [(report["holes"][id_], _data_url(png)) for id_, png in pictures.close_ups.items()],
        "invented_area": invented_area(report["provenance"]),
        "charts": _charts(report),
        "energy_names": words.energy_names(report),
        "most_rows": MOST_ROWS,
        "most_printed_rows": MOST_PRINTED_ROWS,
    }
    return _environment().get_template(_TEMPLATE).render(common | own)


def _charts(report: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Lay out the histograms that there is something to show of."""
    errors = [row["expected_error"] for row in report["holes"] if row["expected_error"] is not None]
    unit = report["length_unit"]
    counted = [
        (f"Expected error of the filled holes, in {unit}", "holes", histogram.histogram(errors)),
        (
            f"How far the model moved new vertices off the geometric fill, in {unit}",
            "vertices",
            report["provenance"]["displacement"],
        ),
    ]
    return [{"title": title, "noun": noun, "bars": histogram.bars(counts)} for title, noun, counts in counted if counts]


def _data_url(png: bytes) -> str:
    return f"data:image/png;base64,{base64.b64encode(png).decode()}"


def _text(name: str) -> str:
    return (files("quadpatch") / "html_report" / name).read_text("utf-8")


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=FunctionLoader(_text), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters.update(figure=words.figure, percent=words.percent)
    environment.globals.update(words=words, size=histogram)
    return environment
