"""Letter F: what a local stack keeps from other users of the machine, and its processes from each other."""

import os
import stat
import sys
from pathlib import Path

import pytest

from onebox import processes
from onebox.local_stack import LocalStack, owned_folder, programs
from onebox.processes import Program, Supervisor
from tests.waiting import wait_until

SHOW = "import os, sys; print(sorted(os.environ)); sys.stdout.flush()"
CHATTER = """
import sys, time
number = 0
while True:
    print(f"line {number}", flush=True)
    number += 1
"""


@pytest.mark.parametrize("mode", [None, 0o755])
def test_the_data_folder_is_for_its_user_alone(tmp_path: Path, mode: int | None) -> None:
    data = tmp_path / "data"
    if mode is not None:
        data.mkdir(mode)
    for _ in range(2):
        with owned_folder(data):
            assert stat.S_IMODE(data.stat().st_mode) == 0o700
        data.chmod(0o755)  # as an older version left it


def test_a_folder_with_other_things_in_it_keeps_its_mode(tmp_path: Path) -> None:
    data = tmp_path / "home"
    data.mkdir()
    (data / "letters").write_text("")
    data.chmod(0o755)
    with owned_folder(data):
        assert stat.S_IMODE(data.stat().st_mode) == 0o755


@pytest.mark.parametrize(
    ("name", "secrets"),
    [
        ("valkey", []),
        ("dispatcher", ["AWS_SECRET_ACCESS_KEY", "QUADPATCH_DATABASE_URL"]),
        ("worker-1", ["AWS_SECRET_ACCESS_KEY", "OTEL_EXPORTER_OTLP_HEADERS", "QUADPATCH_DATABASE_URL"]),
    ],
)
def test_a_process_gets_the_secrets_that_it_needs_and_no_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, secrets: list[str]
) -> None:
    known = ("AWS_SECRET_ACCESS_KEY", "OTEL_EXPORTER_OTLP_HEADERS", "QUADPATCH_API_KEYS", "QUADPATCH_DATABASE_URL")
    for variable in known:
        monkeypatch.setenv(variable, "a secret of sixteen characters")
    (program,) = (found for found in programs(LocalStack(tmp_path, "127.0.0.1", 8000, 1)) if found.name == name)
    shown = Program("shown", (sys.executable, "-c", SHOW), withheld=program.withheld)
    supervisor = Supervisor([shown], tmp_path / "logs", lambda _: None)
    log = supervisor.log_path("shown")
    try:
        supervisor.start()
        wait_until(lambda: "]" in log.read_text())
        assert [variable for variable in known if f"'{variable}'" in log.read_text()] == secrets
    finally:
        supervisor.stop()


def test_a_log_is_bounded_while_its_program_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    limit = 100_000
    monkeypatch.setattr(processes, "_LOG_LIMIT_BYTES", limit)
    supervisor = Supervisor([Program("chatter", (sys.executable, "-c", CHATTER))], tmp_path, lambda _: None)
    log, before = supervisor.log_path("chatter"), tmp_path / "chatter.log.1"
    try:
        supervisor.start()
        child = supervisor._children[0]
        for _ in range(2):
            wait_until(lambda: log.stat().st_size > limit)
            supervisor._look_after(child)
            assert log.stat().st_size < before.stat().st_size
            assert b"\nline " in before.read_bytes()
    finally:
        supervisor.stop()
    # The program goes on where the file was cut: no hole of zeros in front.
    assert b"\0" not in log.read_bytes()
    assert os.stat(log).st_blocks * 512 <= log.stat().st_size + 65_536
