"""The command line, and those of keys and tenants: `service/key_commands.py`, `service/tenant_commands.py` and what
they share, `service/command_line.py`."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from service.__main__ import main
from tests.waiting import GUARD_S


@pytest.fixture(autouse=True)
def no_settings(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in os.environ if name.startswith("QUADPATCH_")]:
        monkeypatch.delenv(name)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("QUADPATCH_HOST", "0.0.0.0", "QUADPATCH_API_KEYS is empty"),
        ("QUADPATCH_API_KEY", "a-key-of-station-1", "the closest one is QUADPATCH_API_KEYS"),
        ("QUADPATCH_PORT", "eighty", "QUADPATCH_PORT"),
    ],
)
def test_wrong_settings_stop_the_start_with_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], name: str, value: str, message: str
) -> None:
    monkeypatch.setenv(name, value)
    assert main([]) == 1
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1


def test_the_settings_are_printed_as_a_table(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["settings"]) == 0
    assert "| `QUADPATCH_DATABASE_URL` |" in capsys.readouterr().out


def test_an_unknown_command_says_how_it_is_used(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sevre"]) == 2
    assert capsys.readouterr().err.startswith("usage:")


def test_serving_loads_no_numeric_library() -> None:
    """A mesh is never parsed in this process, so nothing that could do it has a place there."""
    code = (
        "import sys; import service.app; "
        "heavy = {'numpy', 'scipy', 'trimesh', 'pymeshlab', 'quadpatch', 'worker'}; print(heavy & set(sys.modules))"
    )
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=GUARD_S, check=True)
    assert ended.stdout.strip() == "set()"


def test_keys_are_made_listed_rotated_and_revoked_without_http(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setenv("QUADPATCH_DATA_DIR", str(tmp_path))
    assert main(["keys", "create", "station 4", "--tenant", "plant-north", "--scope", "read"]) == 0
    shown = capsys.readouterr()
    assert shown.out.startswith("qpk_")
    assert "plant-north: read" in shown.err
    assert main(["keys", "list"]) == 0
    table = capsys.readouterr().out
    assert "station 4" in table
    assert shown.out.strip() not in table
    key_id = table.splitlines()[1].split()[0]
    assert main(["keys", "rotate", key_id]) == 0
    assert capsys.readouterr().out != shown.out
    assert main(["keys", "revoke", key_id]) == 0
    main(["keys", "list"])
    assert "revoked 2" in capsys.readouterr().out
    assert main(["keys", "rotate", key_id]) == 1
    assert "was revoked" in capsys.readouterr().err
    assert main(["keys", "create", "x", "--tenant", "Plant North"]) == 2
    assert capsys.readouterr().err.startswith("quadpatch: tenant:")
    for wrong in (["--scope", "all"], ["--expires", "tomorrow"], ["--expires", "2027-01-01T00:00:00"]):
        with pytest.raises(SystemExit, match="2"):
            main(["keys", "create", "x", *wrong])
        assert capsys.readouterr().err.startswith("quadpatch: argument --")


def test_tenants_are_listed_shown_and_limited_without_http(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setenv("QUADPATCH_DATA_DIR", str(tmp_path))
    assert main(["tenants", "show", "plant-north"]) == 1
    assert "there is no tenant plant-north" in capsys.readouterr().err
    assert main(["tenants", "set", "plant-north", "--jobs-waiting", "7", "--streams", "0"]) == 0
    shown = capsys.readouterr().out
    assert [line.split() for line in shown.splitlines() if line.startswith("jobs_waiting")] == [
        ["jobs_waiting", "7", "yes", "0"]
    ]
    assert main(["tenants", "set", "plant-north", "--jobs-waiting", "default", "--disable"]) == 0
    assert "disabled" in capsys.readouterr().out
    assert main(["tenants", "list"]) == 0
    table = [line.split()[0] for line in capsys.readouterr().out.splitlines()]
    assert table == ["TENANT", "default", "plant-north"]
    assert main(["tenants", "set", "plant-north", "--enable"]) == 0
    assert "disabled" not in capsys.readouterr().out
    assert main(["tenants", "set", "default", "--disable"]) == 1
    assert main(["tenants", "set", "plant-north", "--streams", str(2**60)]) == 2
    for wrong in (["--jobs-waiting", "many"], ["--disable", "--enable"], ["--jobs", "1"]):
        with pytest.raises(SystemExit) as ended:
            main(["tenants", "set", "plant-north", *wrong])
        assert ended.value.code == 2
    with pytest.raises(SystemExit):
        main(["tenants", "set", "Plant North"])
