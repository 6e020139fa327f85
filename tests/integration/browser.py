"""A headless Chromium with WebGL in software, and what the tests of the page do in it."""

import base64
import io
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast
from urllib.parse import urlsplit

import httpx
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from playwright.sync_api import Browser, Locator, Page, expect, sync_playwright

from tests.waiting import GUARD_S, wait_until

ROOT = Path(__file__).parents[2]
AXE = ROOT / "web" / "node_modules" / "axe-core" / "axe.min.js"
_FLAGS = ("--no-sandbox", "--disable-background-networking", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
_OCTETS = {"Content-Type": "application/octet-stream"}
_DROP = """([area, name, text]) => {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File([bytes], name));
    for (const type of ["dragover", "drop"])
        area.dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true }));
}"""
# Through the object model: the page's policy takes no style sheet from elsewhere.
_BARE = """(canvas, isBare) => {
    const area = canvas.parentElement;
    const set = (element, name, value) =>
        isBare ? element.style.setProperty(name, value, "important") : element.style.removeProperty(name);
    set(area, "background", "#00ff00");
    for (const other of area.children) if (other !== canvas) set(other, "visibility", "hidden");
}"""
_AXE = "() => axe.run().then(({violations}) => violations.map(({id, nodes}) => [id, nodes.map((n) => n.html)]))"


@dataclass
class Visit:
    """A page of the service in a browser: what it asks for, and what goes wrong in it."""

    page: Page
    url: str
    asked: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)

    def go(self, path: str) -> None:
        """Open a part of the page, such as `jobs`."""
        self.page.goto(f"{self.url}/#/{path}")

    def drop(self, area: Locator, name: str, content: bytes) -> None:
        """Drag a file into an area and drop it there."""
        area.evaluate(f"(area, rest) => ({_DROP})([area, ...rest])", [name, base64.b64encode(content).decode()])

    def violations(self) -> list[Any]:
        """What axe-core has to say against what is shown now."""
        # As a debugger would, since the page's own policy keeps other scripts out.
        self.page.evaluate(AXE.read_text("utf-8") + ";0")
        return cast(list[Any], self.page.evaluate(_AXE))

    def picture(self) -> NDArray[np.uint8]:
        """The 3D view as (height, width, 3); where nothing is drawn it is pure green."""
        canvas = self.page.locator("canvas")
        canvas.evaluate(_BARE, True)
        png = canvas.screenshot()
        canvas.evaluate(_BARE, False)
        return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"))

    def hosts(self) -> set[str]:
        """Where requests went to, the page's own memory aside."""
        return {urlsplit(url).netloc for url in self.asked if not url.startswith(("blob:", "data:"))}


@contextmanager
def running_chromium() -> Iterator[Browser]:
    """Start the Chromium of the system; skip where there is none."""
    program = shutil.which("chromium")
    if program is None:
        pytest.skip("Chromium is not installed; it is a package of Debian")
    expect.set_options(timeout=GUARD_S * 1000)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=list(_FLAGS), timeout=GUARD_S * 1000)
        try:
            yield browser
        finally:
            browser.close()


@contextmanager
def visiting(browser: Browser, url: str, **options: Any) -> Iterator[Visit]:
    """Open a window of its own, without the storage of others."""
    context = browser.new_context(**{"locale": "en-GB", "viewport": {"width": 1280, "height": 900}, **options})
    context.set_default_timeout(GUARD_S * 1000)
    page = context.new_page()
    visit = Visit(page, url)
    page.on("request", lambda request: visit.asked.append(request.url))
    page.on("pageerror", lambda error: visit.errors.append(str(error)))
    page.on("console", lambda message: visit.errors.extend([message.text] if "Policy" in message.text else []))
    try:
        yield visit
    finally:
        context.close()


class Service:
    """The service as the tests of the page need it besides: scans that are there, and bytes to compare with."""

    def __init__(self, url: str) -> None:
        self.http = httpx.Client(base_url=url, timeout=GUARD_S, trust_env=False)

    def upload(self, content: bytes, filename: str) -> str:
        """Upload a mesh, and wait until it is analysed; return its id."""
        mesh = self.http.post("/v1/meshes", params={"filename": filename}, content=content, headers=_OCTETS).json()[
            "id"
        ]
        return str(wait_until(lambda: self.get(f"/v1/meshes/{mesh}?wait=10")["state"] != "analysing" and mesh))

    def repair(self, mesh: str, **spec: Any) -> str:
        """Repair a mesh by geometry alone; return the id of the job that has ended."""
        wanted = {"mesh_id": mesh, "method": {"method": "smooth"}, **spec}
        job = self.http.post("/v1/jobs", json=wanted).raise_for_status().json()["id"]
        return str(wait_until(lambda: self.get(f"/v1/jobs/{job}")["finished_at"] and job))

    def get(self, path: str) -> Any:
        """Return what a path answers as JSON."""
        return self.http.get(path).raise_for_status().json()

    def bytes_of(self, path: str) -> bytes:
        """Return what a path answers."""
        return self.http.get(path).raise_for_status().content
