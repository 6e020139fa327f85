"""Also tests `onebox.__main__`."""

import os
import re
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from onebox.demo import find_scan
from onebox.errors import StartError
from onebox.local_stack import (
    LocalStack,
    check_settings,
    default_workers,
    owned_folder,
    programs,
    ready_check,
    usable_port,
)
from tests.waiting import GUARD_S


def serve(*arguments: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "onebox", "serve", *map(str, arguments)]
    variables = {**os.environ, **environment}
    return subprocess.run(command, env=variables, capture_output=True, text=True, check=False, timeout=GUARD_S)


def test_a_free_port_is_found_and_a_taken_one_refused() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(StartError, match=f"port {port}: Address already in use; choose another --port"):
            usable_port("127.0.0.1", port)
        assert usable_port("127.0.0.1", 0) not in (0, port)


def test_an_address_of_another_machine_is_refused() -> None:
    with pytest.raises(StartError, match=r"can't listen on 192\.0\.2\.1"):
        usable_port("192.0.2.1", 0)


def test_a_folder_belongs_to_one_local_stack_at_a_time(tmp_path: Path) -> None:
    with (
        owned_folder(tmp_path / "data"),
        pytest.raises(StartError, match=f"process {os.getpid()}, uses"),
        owned_folder(tmp_path / "data"),
    ):
        pass
    with owned_folder(tmp_path / "data"):
        pass


def test_a_folder_that_can_not_be_made_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(StartError, match="can't be used"), owned_folder(tmp_path / "file" / "data"):
        pass


def test_a_local_stack_is_made_of_valkey_api_and_workers_that_share_a_folder(tmp_path: Path) -> None:
    stack = LocalStack(tmp_path, "127.0.0.1", 8000, 3)
    valkey, *rest = programs(stack)
    assert [program.name for program in rest] == ["dispatcher", "api", "worker-1", "worker-2", "worker-3"]
    assert {program.environment["QUADPATCH_DATA_DIR"] for program in rest} == {str(tmp_path)}
    assert {program.environment["QUADPATCH_REDIS_URL"] for program in rest} == {f"unix://{tmp_path}/valkey/valkey.sock"}
    assert valkey.name == "valkey"
    assert not any(program.ready() for program in (valkey, *rest))


@pytest.mark.parametrize(
    ("host", "url"),
    [("127.0.0.1", "http://127.0.0.1:1"), ("0.0.0.0", "http://127.0.0.1:1"), ("::1", "http://[::1]:1")],
)
def test_a_local_stack_is_reached_from_its_own_machine(host: str, url: str) -> None:
    assert LocalStack(Path(), host, 1, 1).url == url


def test_a_service_that_does_not_answer_is_not_ready() -> None:
    assert not ready_check(f"http://127.0.0.1:{usable_port('127.0.0.1', 0)}/readyz")()


def test_there_are_at_least_two_workers() -> None:
    assert default_workers() >= 2


def test_the_scan_of_the_demo_ships_with_pymeshlab() -> None:
    assert find_scan().stat().st_size == 5_209_320


def test_serve_says_in_a_line_why_it_can_not_start(tmp_path: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        refused = serve("--port", str(taken.getsockname()[1]), "--data", tmp_path)
    assert refused.returncode == 1
    assert re.fullmatch(r"error: can't listen on 127.0.0.1, port \d+: .* or 0 for any\n", refused.stderr)
    assert serve("--workers", "many", "--data", tmp_path).returncode == 2


def test_wrong_settings_are_told_before_anything_is_started(tmp_path: Path) -> None:
    exposed = serve("--host", "0.0.0.0", "--port", "0", "--data", tmp_path)
    assert exposed.returncode == 1
    assert "QUADPATCH_API_KEYS is empty" in exposed.stderr
    mistyped = serve("--port", "0", "--data", tmp_path, QUADPATCH_LAESE_S="30")
    assert "QUADPATCH_LAESE_S is no setting" in mistyped.stderr
    assert "QUADPATCH_API_KEYS" not in mistyped.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_key_made_in_the_data_folder_opens_the_stack_to_others(tmp_path: Path) -> None:
    environment = {**os.environ, "QUADPATCH_DATA_DIR": str(tmp_path)}
    command = [sys.executable, "-m", "service", "keys", "create", "operator", "--scope", "admin"]
    made = subprocess.run(command, env=environment, capture_output=True, text=True, check=True, timeout=GUARD_S)
    assert str(tmp_path / "quadpatch.db") in made.stderr
    check_settings("0.0.0.0", tmp_path)
    with pytest.raises(StartError, match=re.escape(str(tmp_path / "elsewhere" / "quadpatch.db"))):
        check_settings("0.0.0.0", tmp_path / "elsewhere")


def test_serve_passes_on_why_a_process_ended(tmp_path: Path) -> None:
    ended = serve("--port", "0", "--data", tmp_path, QUADPATCH_OBJECT_STORE_URL="ftp://nowhere")
    assert ended.returncode == 1
    assert re.search(r"error: \w+ ended at once .*logs", ended.stderr)
    assert "that object store is not supported" in ended.stderr


def test_serve_shows_the_log_of_a_valkey_that_can_not_start(tmp_path: Path) -> None:
    (tmp_path / "valkey").mkdir()
    (tmp_path / "valkey" / "appendonlydir").write_text("in the way")
    broken = serve("--port", "0", "--data", tmp_path)
    assert broken.returncode == 1
    assert "valkey ended at once" in broken.stderr
    assert "appendonlydir" in broken.stderr
