import pytest

from quadpatch.stages import Stages, harmless


def test_a_stage_tells_when_it_starts_and_ends() -> None:
    told: list[tuple[str, float]] = []
    stages = Stages(lambda name, fraction: told.append((name, fraction)))
    with stages.stage("read"):
        stages.progress("read", 0.5)
    with stages.stage("fill"):
        pass
    assert told == [("read", 0.0), ("read", 0.5), ("read", 1.0), ("fill", 0.0), ("fill", 1.0)]
    assert list(stages.seconds) == ["read", "fill"]
    assert all(seconds >= 0 for seconds in stages.seconds.values())


def test_a_stage_that_comes_twice_adds_up() -> None:
    stages = Stages()
    with stages.stage("learn"):
        pass
    first = stages.seconds["learn"]
    with stages.stage("learn"):
        pass
    assert stages.seconds["learn"] >= first
    assert list(stages.seconds) == ["learn"]


def test_a_stage_that_fails_has_its_time_but_no_end() -> None:
    told: list[float] = []
    stages = Stages(lambda _, fraction: told.append(fraction))
    with pytest.raises(ValueError, match="no"), stages.stage("fill"):
        raise ValueError("no")
    assert told == [0.0]
    assert "fill" in stages.seconds


def test_a_listener_that_fails_ends_nothing_and_is_not_called_again() -> None:
    calls: list[str] = []

    def listen(stage: str, fraction: float) -> None:
        calls.append(stage)
        raise BrokenPipeError("the terminal is gone")

    stages = Stages(harmless(listen))
    with stages.stage("read"):
        pass
    with stages.stage("fill"):
        pass
    assert calls == ["read"]
    assert list(stages.seconds) == ["read", "fill"]
