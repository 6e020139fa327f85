"""The page of documentation, also as a browser shows it."""

import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from pydantic import SecretStr
from starlette.testclient import TestClient

from jobkit.settings import Settings
from service.app import create_app
from tests.waiting import GUARD_S


def test_the_page_needs_no_key_and_names_no_other_machine(settings: Settings) -> None:
    keyed = settings.model_copy(update={"api_keys": SecretStr("a-key-of-station-1")})
    with TestClient(create_app(keyed), base_url="http://127.0.0.1") as client:
        assert client.get("/v1/jobs").status_code == 401
        page = client.get("/docs")
        assert page.headers["content-type"].startswith("text/html")
        assert "script-src 'self'" in page.headers["content-security-policy"]
        assert "://" not in page.text
        names = re.findall(r'(?:src|href)="([^"]+)"', page.text)
        assert {"docs/docs.js", "docs/swagger-ui-bundle.js", "docs/swagger-ui.css", "openapi.yaml"} <= set(names)
        for name in names:
            if not name.startswith("data:"):
                assert client.get(f"/{name}").raise_for_status().content
        assert client.get("/docs/redoc.standalone.js").status_code == 401


def test_a_browser_shows_every_operation_and_asks_no_other_machine(
    serve: Callable[..., Any], client: TestClient, tmp_path: Path
) -> None:
    chromium = shutil.which("chromium")
    if chromium is None:
        pytest.skip("Chromium is not installed; it is a package of Debian")
    with serve() as service:
        done = subprocess.run(
            [
                chromium,
                "--headless=new",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-background-networking",
                "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
                f"--user-data-dir={tmp_path}",
                "--virtual-time-budget=20000",
                "--dump-dom",
                f"{service.url}/docs",
            ],
            capture_output=True,
            text=True,
            timeout=GUARD_S,
            check=True,
        )
    document = client.get("/openapi.json").json()
    shown = re.findall(r'id="operations-[a-z]+-(\w+)"', done.stdout)
    assert {o["operationId"] for item in document["paths"].values() for o in item.values()} <= set(shown)
    assert "Content Security Policy" not in done.stderr
