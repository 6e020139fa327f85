"""From a report to its page. The page shows what stands in the report, and nothing else.

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

from jinja2 import Environment, FunctionLoader, StrictUndefined, Template

from quadpatch.html_report import histogram, words

# A table of more rows is cut short, on the screen and on paper; the JSON inside the page has all holes.
MOST_ROWS = 10_000
MOST_PRINTED_ROWS = 400
_TEMPLATE = "report.html.jinja"


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
        Of a repair, JSON-ready.
    pictures : Pictures, optional

    Returns
    -------
    str
        An HTML document, with the report as JSON inside.
    """
    pictures = pictures or Pictures()
    style = _text("style.css")
    return _template().render(
        report=report,
        style=style,
        style_hash=base64.b64encode(hashlib.sha256(style.encode()).digest()).decode(),
        overview=_data_url(pictures.overview) if pictures.overview else None,
        close_ups=[(report["holes"][id_], _data_url(png)) for id_, png in pictures.close_ups.items()],
        invented_area=_invented_area(report["provenance"]),
        charts=_charts(report),
        energy_names=words.energy_names(report),
        json=json.dumps(report, indent=1),
        most_rows=MOST_ROWS,
        most_printed_rows=MOST_PRINTED_ROWS,
    )


def _invented_area(facts: Mapping[str, Any]) -> float | None:
    """Share of the repaired surface that is invented."""
    before, after = facts["before"]["area"], facts["after"]["area"]
    return None if before is None or not after else max(0.0, 1 - before / after)


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
def _template() -> Template:
    environment = Environment(
        loader=FunctionLoader(_text), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters.update(figure=words.figure, percent=words.percent)
    environment.globals.update(words=words, size=histogram)
    return environment.get_template(_TEMPLATE)
