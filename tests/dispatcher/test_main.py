from pathlib import Path

import pytest

from jobkit.database.leadership import DISPATCHER, current_leader
from jobkit.database.session import Database
from jobkit.readiness import READY_FILE_VARIABLE
from jobkit.settings import Settings
from tests.dispatcher.process import dispatching
from tests.waiting import wait_until


def test_a_dispatcher_leads_and_is_ready_until_it_is_asked_to_end(
    settings: Settings, database: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ready = tmp_path / "ready"
    monkeypatch.setenv(READY_FILE_VARIABLE, str(ready))
    with dispatching(settings) as process:
        leader = wait_until(lambda: current_leader(database, DISPATCHER), process)
        assert leader.left_s > 0
        assert wait_until(lambda: ready.exists() and ready.read_text(), process) == str(process.pid)
    assert process.returncode == 0
    assert not ready.exists()
