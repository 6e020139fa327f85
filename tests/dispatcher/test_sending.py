import asyncio
import socket
import ssl
import time
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from ipaddress import ip_address
from pathlib import Path
from typing import Any

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from standardwebhooks import Webhook, WebhookVerificationError

from dispatcher.sending import Answer, LookUp, Outgoing, Sender
from jobkit.egress import parse_networks
from jobkit.webhooks.subscriptions import new_secret
from tests.dispatcher.receivers import LOOPBACK, Receiver, receiving, talking
from tests.waiting import GUARD_S

NAME = "receiver.example"
BODY = '{"type":"webhook.test","data":{"word":"größer"}}'


@pytest.fixture
def receiver() -> Iterator[Receiver]:
    with receiving() as receiver:
        yield receiver


def send(url: str, *secrets: str, allowed: str = LOOPBACK, timeout_s: float = GUARD_S, **values: Any) -> Answer:
    sender = Sender(parse_networks(allowed), timeout_s, **values)
    try:
        return asyncio.run(sender.send(Outgoing(url, "msg_1", secrets or (new_secret(),), BODY)))
    finally:
        sender.close()


def looked_up(*rounds: list[str]) -> LookUp:
    """Give other addresses at each look-up, and fail when there are more look-ups than these."""
    left = list(rounds)
    return lambda _: [ip_address(text) for text in left.pop(0)]


def test_a_message_is_signed_as_standard_webhooks_has_it(receiver: Receiver) -> None:
    secret = new_secret()
    answer = send(receiver.url(), secret)
    (request,) = receiver.received
    assert answer.is_delivered
    assert (answer.status, answer.error, request.path) == (204, None, "/hook?a=1")
    assert Webhook(secret).verify(request.body, request.headers)["data"] == {"word": "größer"}
    assert request.headers["content-type"] == "application/json"
    with pytest.raises(WebhookVerificationError):
        Webhook(new_secret()).verify(request.body, request.headers)
    with pytest.raises(WebhookVerificationError):
        Webhook(secret).verify(request.body + b" ", request.headers)


def test_each_of_two_secrets_verifies_while_they_change_over(receiver: Receiver) -> None:
    old, new = new_secret(), new_secret()
    send(receiver.url(), new, old)
    (request,) = receiver.received
    for secret in (old, new):
        assert Webhook(secret).verify(request.body, request.headers)["data"] == {"word": "größer"}


def test_the_connection_goes_to_the_address_that_was_judged_and_the_name_is_resolved_once(receiver: Receiver) -> None:
    answer = send(receiver.url(NAME), look_up=looked_up(["127.0.0.1"]))
    assert answer.is_delivered
    assert receiver.received[0].headers["host"] == f"{NAME}:{receiver.port}"


def test_a_name_that_changes_its_meaning_is_refused_at_the_next_message(receiver: Receiver) -> None:
    look_up = looked_up(["127.0.0.1"], ["127.0.0.1", "169.254.169.254"])
    assert send(receiver.url(NAME), look_up=look_up).is_delivered
    second = send(receiver.url(NAME), look_up=look_up)
    assert second.status is None
    assert second.error is not None
    assert second.error.startswith("webhook_address_refused: ")
    assert len(receiver.received) == 1


def test_without_an_allowed_network_nothing_reaches_this_machine(receiver: Receiver) -> None:
    for host in ("127.0.0.1", "localhost", "[::ffff:127.0.0.1]"):
        for url in (receiver.url(host), receiver.url(host).replace("http:", "https:")):
            answer = send(url, allowed="")
            assert str(answer.error).startswith("webhook_address_refused: ")
    assert receiver.received == []


def test_a_host_with_several_addresses_is_reached_by_the_first_that_answers(receiver: Receiver) -> None:
    answer = send(receiver.url(NAME), look_up=looked_up(["127.0.0.2", "127.0.0.1"]))
    assert answer.is_delivered


def test_redirects_are_not_followed(receiver: Receiver) -> None:
    receiver.answers = [(302, {"Location": receiver.url(path="/elsewhere")})]
    answer = send(receiver.url())
    assert (answer.status, answer.error) == (302, "answered 302; redirects are not followed")
    assert [request.path for request in receiver.received] == ["/hook?a=1"]


def test_proxies_and_cookies_play_no_part(receiver: Receiver, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HTTP_PROXY", "http://127.0.0.1:9")
    receiver.answers = [(200, {"Set-Cookie": "a=b"})]
    sender = Sender(parse_networks(LOOPBACK), GUARD_S)

    async def twice() -> list[Answer]:
        return [await sender.send(Outgoing(receiver.url(), "msg_1", (new_secret(),), BODY)) for _ in range(2)]

    assert all(answer.is_delivered for answer in asyncio.run(twice()))
    sender.close()
    assert not any("cookie" in request.headers for request in receiver.received)


def test_a_refusal_says_when_to_come_back(receiver: Receiver) -> None:
    receiver.answers = [(503, {"Retry-After": "77"})]
    answer = send(receiver.url())
    assert (answer.status, answer.error, answer.retry_after_s) == (503, "answered 503", 77.0)


def test_a_receiver_that_does_not_answer_is_left_in_time() -> None:
    with receiving(held=True) as receiver:
        assert send(receiver.url(), timeout_s=0.3).error == "no answer within 0.3 s"


@pytest.mark.parametrize("head", [b"", b"HTTP/1.1 200 OK\r\nContent-Length: 10000\r\n\r\n"])
def test_a_receiver_that_answers_a_byte_at_a_time_is_left_in_time(head: bytes) -> None:
    def drip(connection: socket.socket) -> None:
        connection.sendall(head)
        for byte in b"HTTP/1.1 200 OK\r\nX: " + b"x" * 10_000:
            connection.sendall(bytes([byte]))
            time.sleep(0.02)

    with talking(drip) as url:
        answer = send(url, timeout_s=0.5)
    assert (answer.status, answer.error) == (None, "no answer within 0.5 s")


def test_an_answer_without_end_is_cut_off_and_its_status_counts() -> None:
    def pour(connection: socket.socket) -> None:
        connection.sendall(b"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n")
        while True:
            connection.sendall(b"1000\r\n" + bytes(4096) + b"\r\n")

    with talking(pour) as url:
        answer = send(url, timeout_s=GUARD_S)
    assert (answer.status, answer.is_delivered) == (200, True)


def test_what_is_no_http_is_no_answer_and_none_of_it_is_kept() -> None:
    with talking(lambda connection: connection.sendall(b"SSH-2.0-secret\r\n")) as url:
        answer = send(url)
    assert answer.status is None
    assert "secret" not in str(answer.error)


def test_over_tls_certificate_and_server_name_are_those_of_the_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    context, certificate, names = tls(tmp_path, NAME)
    monkeypatch.setenv("SSL_CERT_FILE", str(certificate))
    with receiving(context) as receiver:
        assert send(receiver.url(NAME), look_up=looked_up(["127.0.0.1"])).is_delivered
        assert names == [NAME]
        wrong = send(receiver.url("other.example"), look_up=looked_up(["127.0.0.1"]))
        assert wrong.status is None
        assert "CERTIFICATE_VERIFY_FAILED" in str(wrong.error)
        # A server at the address without the certificate gets nothing.
        assert len(receiver.received) == 1


def test_a_certificate_of_an_unknown_authority_is_refused(tmp_path: Path) -> None:
    context, _, _ = tls(tmp_path, NAME)
    with receiving(context) as receiver:
        answer = send(receiver.url(NAME), look_up=looked_up(["127.0.0.1"]))
        assert "CERTIFICATE_VERIFY_FAILED" in str(answer.error)
        assert receiver.received == []


def tls(folder: Path, name: str) -> tuple[ssl.SSLContext, Path, list[str | None]]:
    """Return a server's context for a name, its certificate, and a list that gets the names that clients ask for."""
    key = ec.generate_private_key(ec.SECP256R1())
    subject = x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, name)])
    now = datetime.now(UTC)
    certificate = (
        x509.CertificateBuilder(subject, subject, key.public_key(), x509.random_serial_number())
        .not_valid_before(now - timedelta(hours=1))
        .not_valid_after(now + timedelta(hours=1))
        .add_extension(x509.SubjectAlternativeName([x509.DNSName(name)]), critical=False)
        .add_extension(x509.BasicConstraints(ca=True, path_length=None), critical=True)
        .sign(key, hashes.SHA256())
    )
    certificate_file, key_file = folder / "certificate.pem", folder / "key.pem"
    certificate_file.write_bytes(certificate.public_bytes(serialization.Encoding.PEM))
    key_file.write_bytes(
        key.private_bytes(serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption())
    )
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(certificate_file, key_file)
    names: list[str | None] = []
    context.sni_callback = lambda _socket, asked, _context: names.append(asked)
    return context, certificate_file, names
