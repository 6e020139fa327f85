"""A repair with a page, and a page as a reader of HTML sees it."""

from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

from quadpatch.html_report.provenance import note_start
from quadpatch.html_report.writing import PageOrder, add_html_report
from quadpatch.repair import RepairedFile, repair_and_keep
from tests.quadpatch.shapes import punched, sphere, write_ply

# Elements without an end tag.
_VOID = {"meta", "img", "link", "br", "input"}
# What a client may write into names, labels and metadata.
HOSTILE = "<script>alert(1)</script>\"'><img src=http://127.0.0.1:9/x onerror=alert(2)>{{ 7 * 7 }}</textarea><b>"


def ball(folder: Path, name: str = "in.ply") -> Path:
    """A ball with two holes."""
    holed = punched(punched(sphere(4), (0.0, 0.0, 1.0), radius=0.3), (1.0, 0.0, 0.0), radius=0.2)
    return write_ply(folder / name, holed)


def repaired_with_page(
    source: Path, page: Path, request: dict[str, Any] | None = None, model: str = "smooth"
) -> RepairedFile:
    """Repair a file and write its page."""
    start, output = note_start(source), page.with_name("out.ply")
    repaired = repair_and_keep(source, output, model)
    add_html_report(repaired, PageOrder(start, output, request), page)
    return repaired


@dataclass
class Element:
    """An element with its attributes, its text, and that of all in it."""

    tag: str
    attributes: dict[str, str]
    parts: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        return "".join(self.parts)


class Page(HTMLParser):
    """All elements of a page, in order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[Element] = []
        self._open: list[Element] = []
        self.feed(text)
        self.close()
        assert self._open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        element = Element(tag, {name: value or "" for name, value in attrs})
        self.elements.append(element)
        if tag not in _VOID:
            self._open.append(element)

    def handle_endtag(self, tag: str) -> None:
        assert self._open.pop().tag == tag

    def handle_data(self, data: str) -> None:
        for element in self._open:
            element.parts.append(data)

    @property
    def text(self) -> str:
        """All of it that a reader sees, without line breaks."""
        return " ".join(self.all("main")[0].text.split())

    def all(self, *tags: str) -> list[Element]:
        return [element for element in self.elements if element.tag in tags]

    def by_id(self, id_: str) -> Element:
        (found,) = [element for element in self.elements if element.attributes.get("id") == id_]
        return found

    def rows(self, id_: str) -> list[list[Element]]:
        """Cells of the rows of a table, as the table has them; a row's numbers stand in its `data` elements."""
        found: list[list[Element]] = []
        is_inside = False
        for element in self.elements:
            if element.tag == "table":
                is_inside = element.attributes.get("id") == id_
            elif is_inside and element.tag == "tr":
                found.append([])
            elif is_inside and element.tag in {"td", "th", "data"}:
                found[-1].append(element)
        return found[1:]
