"""The report as page and PDF over HTTP, on a real stack with keys: whom it names, and that it names no other."""

import shutil
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

import httpx
from typer.testing import CliRunner

from quadpatch_client.cli import app
from quadpatch_client.exit_codes import ExitCode
from tests.integration.conftest import RunningStack, punched_relief, stl_bytes
from tests.waiting import GUARD_S, wait_until

OPERATOR_KEY = "the-key-of-the-operator"
CHROMIUM = shutil.which("chromium") or ""
SPEC = {"method": {"method": "smooth"}, "output": {"preview": False, "html_report": True}}


def test_a_report_names_the_key_that_asked_for_it_and_no_other(
    run_stack: Callable[..., AbstractContextManager[RunningStack]],
) -> None:
    with (
        run_stack(QUADPATCH_API_KEYS=OPERATOR_KEY, QUADPATCH_PDF_RENDERER=CHROMIUM) as stack,
        httpx.Client(base_url=stack.url, headers={"X-API-Key": OPERATOR_KEY}, timeout=GUARD_S) as client,
    ):
        mesh = client.post("/v1/meshes?filename=scan.stl", content=stl_bytes(*punched_relief(20))).json()["id"]
        jobs = {}
        for name in ("station 4", "station 5", "settings"):
            key = OPERATOR_KEY
            if name != "settings":
                key = client.post("/v1/keys", json={"name": name, "scopes": ["repair"]}).json()["key"]
            made = client.post("/v1/jobs", json={"mesh_id": mesh, **SPEC}, headers={"X-API-Key": key})
            jobs[name] = made.raise_for_status().json()["links"]["self"]
            wait_until(lambda path=jobs[name]: client.get(path).json()["state"] == "succeeded")  # type: ignore[misc]
        for name, path in jobs.items():
            assert client.get(f"{path}/report").json()["provenance"]["request"]["asked_by"] == name
            page = client.get(f"{path}/report.html").text
            assert name in page
            assert not [other for other in jobs if other.startswith("station") and other != name and other in page]
            printed = client.get(f"{path}/report.pdf")
            # Where there is no Chromium, it says so.
            assert printed.content.startswith(b"%PDF-") if CHROMIUM else "no renderer" in printed.json()["detail"]


def test_a_pdf_is_fetched_where_the_service_prints_one(
    run_stack: Callable[..., AbstractContextManager[RunningStack]], tmp_path: Path
) -> None:
    (tmp_path / "scan.stl").write_bytes(stl_bytes(*punched_relief(20)))
    pdf = tmp_path / "report.pdf"
    command = ["repair", tmp_path / "scan.stl", "-o", tmp_path / "out.stl", "--method", "smooth", "--pdf", pdf]
    with run_stack(QUADPATCH_PDF_RENDERER=CHROMIUM) as stack:
        done = CliRunner().invoke(app, [*map(str, command)], env={"QUADPATCH_CLIENT_URL": stack.url})
    if CHROMIUM:
        assert done.exit_code == ExitCode.OK, done.stderr
        assert pdf.read_bytes().startswith(b"%PDF-")
    else:
        assert done.exit_code == ExitCode.USAGE
        assert "prints no PDFs" in " ".join(done.stderr.split())


def test_a_service_that_prints_none_is_told_before_a_scan_is_sent(local_stack: RunningStack, tmp_path: Path) -> None:
    (tmp_path / "unsent.stl").write_bytes(stl_bytes(*punched_relief(21)))
    command = ["repair", tmp_path / "unsent.stl", "-o", tmp_path / "out.stl", "--pdf", tmp_path / "report.pdf"]
    refused = CliRunner().invoke(app, [*map(str, command)], env={"QUADPATCH_CLIENT_URL": local_stack.url})
    assert refused.exit_code == ExitCode.USAGE
    assert "prints no PDFs; leave out --pdf, take --html" in " ".join(refused.stderr.split())
    assert httpx.get(f"{local_stack.url}/v1/meshes?filename=unsent.stl", timeout=GUARD_S).json()["items"] == []
