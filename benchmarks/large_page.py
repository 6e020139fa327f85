"""The page with a large scan: `python -m benchmarks.large_page 2238` takes a relief of about 10 million triangles.

Prints seconds since the file was chosen, and the memory of the browser's processes (PSS) before and after.
"""

import re
import shutil
import sys
import tempfile
import time
from pathlib import Path

import psutil
from playwright.sync_api import sync_playwright

from onebox.demo import running_stack
from tests.integration.conftest import ply_bytes, punched_relief

_FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
_WAIT_MS = 1_200_000
# Marks that the page leaves on its canvas; a plan is there once the analysis has ended.
_EVENTS = {
    "first picture": "canvas[data-before]",
    "holes listed": "tr[data-hole='1'] small.closed",
    "holes outlined": "canvas[data-outlines]",
    "finer picture": "canvas[data-before='fine']",
}


def main(n: int) -> None:
    """Upload a relief of n by n vertices with four holes, and watch the page."""
    with tempfile.TemporaryDirectory() as folder, running_stack(Path(folder)) as url, sync_playwright() as playwright:
        scan = Path(folder) / "large.ply"
        scan.write_bytes(ply_bytes(*punched_relief(n)))
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=_FLAGS)
        page = browser.new_page()
        page.set_default_timeout(_WAIT_MS)
        page.goto(url)
        page.locator(".dropzone").wait_for()
        sys.stdout.write(f"empty page: {_memory()}\n")
        started = time.monotonic()
        page.locator("input[type=file]").set_input_files(scan)
        for name, mark in _EVENTS.items():
            page.locator(mark).wait_for()
            sys.stdout.write(f"{name}: {time.monotonic() - started:.1f} s, {_memory()}\n")
        browser.close()


def _memory() -> str:
    """Return MiB of each kind of process of the browser, the largest of its kind."""
    largest: dict[str, int] = {}
    for process in psutil.Process().children(recursive=True):
        kind = re.search(r"--type=([\w-]+)", " ".join(process.cmdline()))
        if kind and "chrom" in process.name():
            largest[kind[1]] = max(largest.get(kind[1], 0), process.memory_full_info().pss >> 20)
    return ", ".join(f"{kind} {size} MiB" for kind, size in sorted(largest.items()))


if __name__ == "__main__":
    main(int(sys.argv[1]))
