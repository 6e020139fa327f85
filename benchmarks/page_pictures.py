"""Pictures of the page for the documents: `python -m benchmarks.page_pictures docs/images`.

Needs the Chromium of the system; the scan is that of the demo.
"""

import io
import shutil
import sys
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, ViewportSize, sync_playwright

from onebox.demo import find_scan, running_stack

_FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
_SIZE: ViewportSize = {"width": 1360, "height": 940}
_WAIT_MS = 600_000


def main(folder: Path) -> None:
    """Upload the scan, choose for a hole, repair it, and write a picture of each step."""
    with tempfile.TemporaryDirectory() as data, running_stack(Path(data)) as url, sync_playwright() as playwright:
        program = shutil.which("chromium")
        browser = playwright.chromium.launch(executable_path=program, args=_FLAGS)
        page = browser.new_page(viewport=_SIZE, locale="en-GB", reduced_motion="reduce")
        page.set_default_timeout(_WAIT_MS)
        page.goto(url)
        page.locator("input[type=file]").set_input_files(find_scan())
        page.locator("canvas[data-before][data-outlines]").wait_for()
        page.get_by_label("What to do with hole 5", exact=True).select_option("smooth")
        page.get_by_text("holes would be filled").wait_for()
        _save(page, folder / "page_scan.png")
        page.get_by_role("button", name="Start the repair").click()
        page.locator("canvas[data-before][data-after][data-outlines]").wait_for()
        page.get_by_role("button", name="Fly to hole 7", exact=True).click()
        page.locator("canvas[data-hole='7']").wait_for()
        page.get_by_label("Colours show").select_option("confidence")
        page.get_by_role("slider", name="Before and after").fill("0.45")
        _save(page, folder / "page_repair.png")
        browser.close()


def _save(page: Page, path: Path) -> None:
    page.evaluate("scrollTo(0, 0)")
    picture = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    # A palette of the picture's own; octrees keep small patches of strong colour.
    picture.quantize(method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(path, optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
