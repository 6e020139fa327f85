import os
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pytest
import redis

from onebox.errors import StartError
from onebox.valkey import answers, prepare_valkey, running_valkey
from tests.waiting import wait_until


def test_the_server_keeps_its_data_over_a_restart(tmp_path: Path) -> None:
    with running_valkey(tmp_path / "valkey") as url, redis.Redis.from_url(url) as connection:
        connection.rpush("queue", "a", "b")
    with running_valkey(tmp_path / "valkey") as url, redis.Redis.from_url(url) as connection:
        assert connection.lrange("queue", 0, -1) == [b"a", b"b"]


def test_the_server_appends_to_a_file_and_never_evicts(tmp_path: Path) -> None:
    with running_valkey(tmp_path / "valkey") as url, redis.Redis.from_url(url) as connection:
        settings = connection.config_get("*")
    assert settings["appendonly"] == "yes"
    assert settings["maxmemory-policy"] == "noeviction"
    assert settings["port"] == "0"


def test_nothing_answers_after_the_block(tmp_path: Path) -> None:
    setup = prepare_valkey(tmp_path / "valkey")
    with running_valkey(tmp_path / "valkey"):
        wait_until(lambda: answers(setup.socket_path))
    assert not answers(setup.socket_path)


def test_a_folder_with_blanks_and_quotes_and_a_very_long_name_works(tmp_path: Path) -> None:
    folder = tmp_path / 'plant "7" hall' / ("x" * 120)
    with running_valkey(folder) as url, redis.Redis.from_url(url) as connection:
        assert connection.ping()
    assert (folder / "appendonlydir").is_dir()


def test_a_server_that_can_not_start_says_why(tmp_path: Path) -> None:
    folder = tmp_path / "valkey"
    folder.mkdir()
    (folder / "appendonlydir").write_text("in the way")
    with pytest.raises(StartError, match="appendonlydir"), running_valkey(folder):
        pass


def test_the_server_ends_with_a_killed_parent(tmp_path: Path) -> None:
    script = (
        "import sys, time; from pathlib import Path; from onebox.valkey import running_valkey\n"
        "with running_valkey(Path(sys.argv[1])): print('up', flush=True); time.sleep(999)"
    )
    parent = subprocess.Popen([sys.executable, "-c", script, str(tmp_path / "valkey")], stdout=subprocess.PIPE)
    assert parent.stdout is not None
    assert parent.stdout.readline() == b"up\n"
    (server,) = psutil.Process(parent.pid).children()
    os.kill(parent.pid, signal.SIGKILL)
    parent.wait()
    parent.stdout.close()
    wait_until(lambda: has_ended(server))
    assert not answers(tmp_path / "valkey" / "valkey.sock")


def has_ended(process: psutil.Process) -> bool:
    try:
        return not process.is_running() or process.status() == psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return True
