import os
from pathlib import Path

import pytest

from jobkit.readiness import READY_FILE_VARIABLE, ready_file


def test_the_file_stands_while_the_worker_is_ready(tmp_path: Path) -> None:
    path = tmp_path / "ready"
    with ready_file({READY_FILE_VARIABLE: str(path)}):
        assert path.read_text() == str(os.getpid())
    assert not path.exists()


@pytest.mark.parametrize("environment", [{}, {READY_FILE_VARIABLE: ""}])
def test_without_a_name_there_is_no_file(
    environment: dict[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with ready_file(environment):
        assert list(tmp_path.iterdir()) == []
