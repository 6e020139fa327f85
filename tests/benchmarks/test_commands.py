"""Benchmarks that are never part of the tests: their command lines explain themselves, so they can be loaded."""

import importlib
import sys

import pytest

# benchmarks.service runs benchmarks.polling and benchmarks.streaming, and benchmarks.flood runs benchmarks.flooding.
COMMANDS = (
    "benchmarks.batches",
    "benchmarks.flood",
    "benchmarks.flooding",
    "benchmarks.foreign_ids",
    "benchmarks.jobs",
    "benchmarks.memory",
    "benchmarks.polling",
    "benchmarks.service",
    "benchmarks.stages",
    "benchmarks.streaming",
    "benchmarks.views",
)


@pytest.mark.parametrize("name", COMMANDS)
def test_a_benchmark_says_how_it_is_called(
    name: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", [name, "--help"])
    with pytest.raises(SystemExit) as caught:
        importlib.import_module(name).main()
    assert caught.value.code == 0
    assert "usage:" in capsys.readouterr().out
