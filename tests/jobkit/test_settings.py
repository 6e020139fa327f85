from pathlib import Path

import pytest

from jobkit.errors import SettingsError
from jobkit.settings import Settings, load_settings, settings_table


def test_no_variable_at_all_gives_one_box_on_loopback(monkeypatch: pytest.MonkeyPatch) -> None:
    settings = load_settings()
    assert settings.host == "127.0.0.1"
    assert settings.effective_database_url.startswith("sqlite:////")
    assert settings.effective_object_store_url.startswith("file:///")


def test_variables_are_read(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("QUADPATCH_DATA_DIR", str(tmp_path))
    monkeypatch.setenv("QUADPATCH_MAX_UPLOAD_MB", "7")
    settings = load_settings()
    assert settings.max_upload_mb == 7
    assert settings.effective_database_url == f"sqlite:///{tmp_path}/quadpatch.db"


def test_a_wrong_name_stops_the_start_and_names_the_right_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("QUADPATCH_MAX_UPLOADS_MB", "7")
    with pytest.raises(SettingsError, match=r"QUADPATCH_MAX_UPLOADS_MB .* QUADPATCH_MAX_UPLOAD_MB$"):
        load_settings()


def test_the_names_of_the_client_are_left_to_it(monkeypatch: pytest.MonkeyPatch) -> None:
    without = load_settings()
    monkeypatch.setenv("QUADPATCH_CLIENT_URL", "http://127.0.0.1:8000")
    assert load_settings() == without


def test_a_wrong_value_is_named_without_being_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("QUADPATCH_PORT", "s3cret")
    with pytest.raises(SettingsError, match="QUADPATCH_PORT") as caught:
        load_settings()
    assert "s3cret" not in str(caught.value)


def test_keys_are_split_and_never_printed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("QUADPATCH_API_KEYS", "first-long-key-000, second-long-key-00")
    settings = load_settings()
    assert settings.key_list == ["first-long-key-000", "second-long-key-00"]
    assert "long-key" not in repr(settings)


def test_a_short_key_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("QUADPATCH_API_KEYS", "first-long-key-000,short")
    with pytest.raises(SettingsError, match="16 characters"):
        load_settings()


def test_a_lease_that_one_missed_heartbeat_ends_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("QUADPATCH_LEASE_S", "6")
    with pytest.raises(SettingsError, match="two heartbeats"):
        load_settings()


def test_every_setting_stands_in_the_table_with_its_meaning() -> None:
    table = settings_table()
    for name, field in Settings.model_fields.items():
        assert f"`QUADPATCH_{name.upper()}`" in table
        assert field.description is not None
        assert field.description in table


def test_secrets_are_read_from_files(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    path = tmp_path / "keys"
    path.write_text("a-key-of-station-1,a-key-of-station-2\n")
    monkeypatch.setenv("QUADPATCH_API_KEYS_FILE", str(path))
    assert load_settings().key_list == ["a-key-of-station-1", "a-key-of-station-2"]
    monkeypatch.setenv("QUADPATCH_API_KEYS", "a-key-of-station-3")
    with pytest.raises(SettingsError, match="both set"):
        load_settings()
    monkeypatch.delenv("QUADPATCH_API_KEYS")
    monkeypatch.setenv("QUADPATCH_API_KEYS_FILE", str(tmp_path / "nothing"))
    with pytest.raises(SettingsError, match="API_KEYS_FILE can't be read"):
        load_settings()


def test_only_secrets_have_files(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("QUADPATCH_PORT_FILE", "port")
    with pytest.raises(SettingsError, match="is no setting"):
        load_settings()
