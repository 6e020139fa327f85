"""Also tests `worker/engine/renderer.py`: what a renderer of PDFs may do, by a real browser and by hostile scripts."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from tests.quadpatch.html_report.pages import ball, repaired_with_page
from tests.quadpatch.html_report.test_browser import browse, listening, loads
from tests.waiting import GUARD_S
from worker.engine.confinement import weaknesses
from worker.engine.limits import EngineLimits
from worker.failures import EngineStoppedError, StopReason
from worker.pdf import add_pdf

CHROMIUM = shutil.which("chromium")
needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed; it is a package of Debian")
pytestmark = pytest.mark.skipif(bool(weaknesses()), reason="this kernel can't confine a renderer")
LIMITS = EngineLimits(time_s=600, memory_mb=4096)
# Finds the path of the PDF among its arguments.
FIND = 'for a in "$@"; do case "$a" in --print-to-pdf=*) out="${a#*=}";; esac; done\n'
PDF = "%PDF-1.4 printed"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The folder of a request whose engine has written a page."""
    folder = tmp_path / "job"
    folder.mkdir()
    (folder / "report.html").write_text("<!DOCTYPE html><title>Report</title>")
    (folder / "report.json").write_text('{"warnings": []}')
    return folder


def renderer(tmp_path: Path, script: str) -> str:
    program = tmp_path / "programs" / "renderer"
    program.parent.mkdir()
    program.write_text(f"#!/bin/sh\n{FIND}{script}\n")
    program.chmod(0o755)
    return str(program)


def warnings_in(folder: Path) -> list[str]:
    found: list[str] = json.loads((folder / "report.json").read_text())["warnings"]
    return found


def names_in(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


@needs_chromium
def test_a_page_becomes_a_pdf_of_a_few_sheets(folder: Path, tmp_path: Path) -> None:
    repaired_with_page(ball(tmp_path), folder / "report.html")
    before = names_in(folder)
    add_pdf(folder, str(CHROMIUM), LIMITS)
    assert warnings_in(folder) == []
    printed = (folder / "report.pdf").read_bytes()
    assert printed.startswith(b"%PDF-")
    assert 2 <= len(re.findall(rb"/Type ?/Page\b", printed)) <= 6
    assert names_in(folder) == before | {"report.pdf"}


@needs_chromium
def test_a_renderer_has_no_network_even_where_a_page_asks_for_it(folder: Path) -> None:
    with listening() as (address, asked):
        (folder / "report.html").write_text(f"<body>{loads(address)}")
        add_pdf(folder, str(CHROMIUM), LIMITS)
        assert asked == []
        assert (folder / "report.pdf").exists()
        browse(folder / "report.html", "--dump-dom")
        assert "/img" in asked


def test_without_a_renderer_or_a_page_nothing_happens(folder: Path, tmp_path: Path) -> None:
    program, before = renderer(tmp_path, f'printf "%s" "{PDF}" >"$out"'), names_in(folder)
    add_pdf(folder, "", LIMITS)
    assert names_in(folder) == before
    (folder / "report.html").unlink()
    add_pdf(folder, program, LIMITS)
    assert names_in(folder) == {"report.json"}
    assert warnings_in(folder) == []


def test_a_renderer_gets_the_page_and_no_password(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("QUADPATCH_API_KEYS", "the-key-of-the-operator")
    script = 'for page in "$@"; do :; done\n{ printf "%%PDF-1.4 "; cat "${page#file://}"; env; } >"$out"'
    add_pdf(folder, renderer(tmp_path, script), LIMITS)
    printed = (folder / "report.pdf").read_text()
    assert "<title>Report</title>" in printed
    assert "HOME=" in printed
    assert "the-key" not in printed
    assert "QUADPATCH" not in printed


@pytest.mark.parametrize(
    ("script", "reason"),
    [
        ('cat "SECRET" >"$out"', "it is none, or too large|ended with status"),
        ('ln -s "SECRET" "$out"', "the renderer left no PDF"),
        ('printf "%s" "<html>" >"$out"', "it is none, or too large"),
        ('{ printf "%%PDF-1.4"; cat "/proc/$PPID/environ"; } >"$out" || exit 4', "status 4"),
        ("exit 0", "No such file"),
        ("exit 3", "status 3"),
        ("kill -9 $$", "status -9"),
    ],
)
def test_a_job_does_without_a_pdf_that_a_renderer_does_not_make(
    folder: Path, tmp_path: Path, script: str, reason: str
) -> None:
    secret = tmp_path / "secret"
    secret.write_text("%PDF-1.4 of another tenant")
    add_pdf(folder, renderer(tmp_path, script.replace("SECRET", str(secret))), LIMITS)
    (warning,) = warnings_in(folder)
    assert warning.startswith("there is no PDF: ")
    assert re.search(reason, warning)
    assert names_in(folder) == {"report.html", "report.json"}


def test_a_renderer_that_is_not_there_is_a_warning(folder: Path, tmp_path: Path) -> None:
    add_pdf(folder, str(tmp_path / "missing"), LIMITS)
    assert len(warnings_in(folder)) == 1


@pytest.mark.parametrize(
    ("limits", "reason"),
    [(EngineLimits(time_s=1, memory_mb=4096), "longer than 1 s"), (EngineLimits(600, 0), "more than 0 MiB")],
)
def test_a_renderer_is_ended_with_all_it_started_at_its_limits(
    folder: Path, tmp_path: Path, limits: EngineLimits, reason: str
) -> None:
    add_pdf(folder, renderer(tmp_path, "sleep 3600 &\nwait"), limits)
    assert reason in warnings_in(folder)[0]
    assert "sleep" not in {child.name() for child in psutil.Process().children(recursive=True)}
    assert not [p for p in psutil.process_iter(["cmdline"]) if str(folder) in " ".join(p.info["cmdline"] or ())]


@needs_chromium
def test_all_processes_of_a_browser_end_with_its_job(folder: Path) -> None:
    (folder / "report.html").write_text("<script>for (;;) {}</script>")

    def processes() -> list[str]:
        found = [" ".join(process.info["cmdline"] or ()) for process in psutil.process_iter(["cmdline"])]
        return [line for line in found if str(folder) in line]

    def stop_reason() -> StopReason | None:
        # It has begun where its profile is there.
        return StopReason.CANCELED if processes() and any(folder.glob("pdf-*/profile/*")) else None

    with pytest.raises(EngineStoppedError):
        add_pdf(folder, str(CHROMIUM), LIMITS, stop_reason)
    assert processes() == []


def test_a_browser_may_talk_to_itself_alone() -> None:
    script = """
import os, socket, sys
from worker.engine.seccomp import restrict_calls_of_a_browser
restrict_calls_of_a_browser()
for family, kind in (("INET", "STREAM"), ("INET", "DGRAM"), ("INET6", "STREAM"), ("NETLINK", "RAW"), ("PACKET", "RAW")):
    try:
        socket.socket(getattr(socket, f"AF_{family}"), getattr(socket, f"SOCK_{kind}"))
    except PermissionError:
        continue
    sys.exit(f"{family} is open")
one, other = socket.socketpair()
if os.fork() == 0:
    one.sendall(b"x")
    os._exit(0)
assert other.recv(1) == b"x"
try:
    socket.socket(socket.AF_UNIX).connect(sys.argv[1])
except PermissionError:
    sys.exit(0)
sys.exit("sockets with names can be reached")
"""
    # The filter answers before the kernel looks for the name.
    command = [sys.executable, "-c", script, "/nowhere"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=GUARD_S, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_renderer_ends_with_its_job(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(EngineStoppedError):
        add_pdf(folder, renderer(tmp_path, "sleep 3600"), LIMITS, lambda: StopReason.CANCELED)
    assert names_in(folder) == {"report.html", "report.json"}
