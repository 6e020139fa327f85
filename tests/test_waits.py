"""No test may depend on the clock: tests wait for events, and time limits only end a test that hangs."""

import ast
from collections.abc import Iterator
from pathlib import Path

import hypothesis
import pytest

TESTS = Path(__file__).parent
# The fault suite injects faults by the clock, and its limits are `GUARD_S`; the others say why they look at it.
MAY_LOOK_AT_THE_CLOCK = {
    "waiting.py": "waits for all tests",
    "quadpatch_client/test_watching.py": "its server stays silent",
    "dispatcher/test_lease_reaper.py": "a moment by the clock is what is handed over",
    "dispatcher/test_sending.py": "its server is slow",
    "jobkit/database/test_leadership.py": "a moment by the clock is what is handed back",
    "worker/rogue_engine.py": "an engine that hangs",
}
CLOCKS = {"sleep", "monotonic", "monotonic_ns", "perf_counter", "perf_counter_ns", "process_time", "time", "time_ns"}
WAITING = {"wait", "wait_for", "join", "result", "communicate", "acquire", "settimeout"}
REQUESTS = {"get", "post", "put", "delete", "patch", "head", "request", "stream", "Client", "AsyncClient"}
FILES = sorted(str(path.relative_to(TESTS)) for path in TESTS.rglob("*.py"))


def calls(tree: ast.AST) -> Iterator[tuple[ast.Call, str, str]]:
    """Yield each call, with the name that is called and the name that this is an attribute of."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            called = node.func
            owner = called.value if isinstance(called, ast.Attribute) else None
            name = called.attr if isinstance(called, ast.Attribute) else getattr(called, "id", "")
            yield node, name, getattr(owner, "id", "")


def number(node: ast.expr) -> float | None:
    is_number = (
        isinstance(node, ast.Constant) and isinstance(node.value, int | float) and not isinstance(node.value, bool)
    )
    return float(node.value) if is_number else None  # type: ignore[attr-defined]


def short_limits(call: ast.Call, name: str) -> list[float]:
    """Return the limits that a call states in seconds."""
    named = [number(keyword.value) for keyword in call.keywords if keyword.arg == "timeout"]
    placed = [number(argument) for argument in call.args[:1]] if name in WAITING else []
    # A pause between two looks is no limit.
    return [limit for limit in (*named, *placed) if limit is not None and not (name == "wait" and limit < 1.0)]


TOO_SLOW = ast.Constant("too_slow")


def faults(source: str, file: str) -> list[str]:
    """Return in words what in a test file goes by the clock."""
    found = []
    may_look = file in MAY_LOOK_AT_THE_CLOCK or file.startswith("faults/")
    for call, name, owner in calls(ast.parse(source)):
        place = f"{file}:{call.lineno}"
        keywords = {keyword.arg: keyword.value for keyword in call.keywords}
        if owner == "time" and name in CLOCKS and not may_look:
            found.append(f"{place} looks at the clock; see tests/waiting.py")
        if not file.startswith("faults/"):
            found += [f"{place} waits for {limit:g} s; take GUARD_S" for limit in short_limits(call, name)]
        if owner == "httpx" and name in REQUESTS and "timeout" not in keywords:
            found.append(f"{place} leaves httpx its 5 s; take GUARD_S")
        if name == "settings" and "deadline" in keywords:
            found.append(f"{place} sets a deadline; the profile in tests/conftest.py has none")
        if name == "settings" and "too_slow" not in ast.dump(keywords.get("suppress_health_check", TOO_SLOW)):
            found.append(f"{place} lets hypothesis judge how long examples take")
    return found


def test_no_test_goes_by_the_clock() -> None:
    assert [fault for file in FILES for fault in faults((TESTS / file).read_text("utf-8"), file)] == []


@pytest.mark.parametrize(
    "source",
    [
        "time.sleep(0.1)",
        "deadline = time.monotonic() + 20",
        "process.wait(30)",
        "thread.join(10)",
        "future.result(timeout=5)",
        "subprocess.run(command, timeout=60)",
        "httpx.get(url)",
        "settings(deadline=400)",
        "settings(suppress_health_check=[HealthCheck.function_scoped_fixture])",
    ],
)
def test_what_goes_by_the_clock_is_found(source: str) -> None:
    assert len(faults(source, "test_x.py")) == 1


def test_examples_have_no_deadline_and_are_the_same_every_time() -> None:
    profile = hypothesis.settings.get_profile("tests")
    assert profile.deadline is None
    assert hypothesis.HealthCheck.too_slow in profile.suppress_health_check
    assert profile.derandomize
