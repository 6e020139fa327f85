import pytest
from starlette.testclient import TestClient


def test_an_id_that_the_client_sends_is_kept(client: TestClient) -> None:
    assert client.get("/healthz", headers={"X-Request-Id": "station-4.17"}).headers["x-request-id"] == "station-4.17"


@pytest.mark.parametrize("sent", ["", "a b", "x" * 65, "<script>"])
def test_an_id_that_could_do_harm_is_replaced(client: TestClient, sent: str) -> None:
    got = client.get("/healthz", headers={"X-Request-Id": sent}).headers["x-request-id"]
    assert got != sent
    assert len(got) == 36


@pytest.mark.parametrize("path", ["/healthz", "/", "/nowhere", "/v1/jobs"])
def test_every_answer_carries_the_headers_of_caution(client: TestClient, path: str) -> None:
    headers = client.get(path).headers
    assert headers["x-content-type-options"] == "nosniff"
    assert "default-src 'none'" in headers["content-security-policy"]
    assert headers["referrer-policy"] == "no-referrer"
    assert headers["cache-control"] == "no-store"
    assert "server" not in headers
