import pytest

from benchmarks import sparse


def test_all_ways_to_code_are_timed(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    for name, value in {"N_BINS": 16, "N_ATOMS": 20, "N_SIGNALS": 300, "N_NONZERO": 3, "N_ALONE": 5}.items():
        monkeypatch.setattr(sparse, name, value)
    sparse.main()
    said = capsys.readouterr().out
    for way in ("masked, every mask its own", "one mask for all", "the matrix products", "one by one"):
        assert way in said
    assert "300 patches" in said
