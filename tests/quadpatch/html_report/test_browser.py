"""Pages of `quadpatch.html_report.page` and `quadpatch.html_report.writing` in a real browser."""

import re
import shutil
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

from tests.quadpatch.html_report.pages import ball, repaired_with_page
from tests.waiting import GUARD_S

CHROMIUM = shutil.which("chromium")
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed; it is a package of Debian")
# A page of figures and pictures, tables and options.
MOST_PAGES = 6


def browse(page: Path, *options: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [
            str(CHROMIUM),
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-background-networking",
            "--enable-logging=stderr",
            f"--user-data-dir={page.parent / 'profile'}",
            *options,
            page.as_uri(),
        ],
        capture_output=True,
        text=True,
        timeout=GUARD_S,
        check=True,
    )


@contextmanager
def listening() -> Iterator[tuple[str, list[str]]]:
    """A server that notes what it is asked for."""
    asked: list[str] = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            asked.append(self.path)
            self.send_response(200)
            self.send_header("Content-Length", "0")
            self.end_headers()

        def log_message(self, *_: object) -> None:
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_port}", asked
        finally:
            server.shutdown()
            thread.join()


def loads(address: str) -> str:
    """What asks for a picture, a style sheet and a script, and follows a link by itself, where it is taken for HTML."""
    return (
        f"</textarea></table><img src='{address}/img'><link rel=stylesheet href='{address}/css'>"
        f"<style>body {{ background: url({address}/background) }}</style><script src='{address}/script'></script>"
        f"<iframe src='{address}/frame'></iframe><svg onload='fetch(`{address}/onload`)'>"
    )


def test_a_page_asks_nothing_of_the_network_and_breaks_no_policy(tmp_path: Path) -> None:
    with listening() as (address, asked):
        request = {"label": loads(address), "metadata": {"order": loads(address)}, "mesh_name": loads(address)}
        repaired_with_page(ball(tmp_path), tmp_path / "report.html", request)
        done = browse(tmp_path / "report.html", "--dump-dom")
        assert asked == []
        assert "Content Security Policy" not in done.stderr
        assert 'id="table-of-holes"' in done.stdout
        (tmp_path / "careless.html").write_text(f"<body>{loads(address)}")
        browse(tmp_path / "careless.html", "--dump-dom")
        assert {"/img", "/css", "/script"} <= set(asked)
        # What escaping might let through one day, the policy of the page stops.
        careless = (tmp_path / "report.html").read_text("utf-8").replace("</main>", f"{loads(address)}</main>")
        asked.clear()
        (tmp_path / "policed.html").write_text(careless, "utf-8")
        done = browse(tmp_path / "policed.html", "--dump-dom")
        assert asked == []
        assert "Content Security Policy" in done.stderr


def test_a_page_prints_to_a_few_sheets(tmp_path: Path) -> None:
    repaired_with_page(ball(tmp_path), tmp_path / "report.html")
    browse(tmp_path / "report.html", "--no-pdf-header-footer", f"--print-to-pdf={tmp_path / 'report.pdf'}")
    printed = (tmp_path / "report.pdf").read_bytes()
    assert printed.startswith(b"%PDF")
    assert 2 <= len(re.findall(rb"/Type ?/Page\b", printed)) <= MOST_PAGES
