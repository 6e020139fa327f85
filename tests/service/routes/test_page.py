"""The page as it is handed out; `tests/integration/test_page.py` uses it in a browser."""

import re
from pathlib import Path

from pydantic import SecretStr
from starlette.testclient import TestClient

from jobkit.settings import Settings
from service.app import create_app
from service.auth import PUBLIC_PATHS
from service.routes.page import ASSETS

FOLDER = Path("service/page")


def test_the_page_needs_no_key_but_its_data_does(settings: Settings) -> None:
    keyed = settings.model_copy(update={"api_keys": SecretStr("a-key-of-station-1")})
    with TestClient(create_app(keyed), base_url="http://127.0.0.1") as client:
        assert client.get("/v1/jobs").status_code == 401
        page = client.get("/")
        assert page.headers["content-type"].startswith("text/html")
        names = re.findall(r'(?:src|href)="(page/[^"]+)"', page.text)
        assert {"page/page.js", "page/page.css", "page/icon.svg"} == set(names)
        for name in ASSETS:
            assert client.get(f"/page/{name}").raise_for_status().content == (FOLDER / name).read_bytes()
        assert client.get("/page/index.html").status_code == 401


def test_what_is_handed_out_lies_in_the_folder_and_is_public() -> None:
    assert {path.name for path in FOLDER.iterdir()} == {"index.html", *ASSETS}
    assert {"/", *(f"/page/{name}" for name in ASSETS)} <= PUBLIC_PATHS


def test_no_script_stands_in_the_page_and_its_policy_allows_none(client: TestClient) -> None:
    page = client.get("/")
    policy = page.headers["content-security-policy"]
    assert "script-src 'self';" in policy
    assert "unsafe" not in policy
    assert re.findall(r"<script[^>]*>([^<]*)</script>", page.text) == [""]
    assert not re.search(r"\son\w+=|style=|<style", page.text)
    assert "://" not in page.text


def test_a_browser_that_has_a_file_gets_it_once(client: TestClient) -> None:
    first = client.get("/page/page.js")
    assert first.headers["cache-control"] == "no-cache"
    second = client.get("/page/page.js", headers={"If-None-Match": first.headers["etag"]})
    assert (second.status_code, second.content) == (304, b"")


def test_what_is_no_file_of_the_page_is_not_there(client: TestClient) -> None:
    answer = client.get("/page/..%2fauth.py")
    assert answer.status_code == 404
    assert client.get("/page/page.tsx").json()["code"] == "route_not_found"
