"""Every test asserts something: by itself, or in a function of the tests that it calls."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
FILES = sorted((ROOT / "tests").rglob("test_*.py"))
RAISING = {"raises", "warns", "fail"}

Function = ast.FunctionDef | ast.AsyncFunctionDef


@cache
def parsed(path: Path) -> ast.Module:
    return ast.parse(path.read_text("utf-8"))


@cache
def functions(tree: ast.Module) -> dict[str, Function]:
    return {node.name: node for node in tree.body if isinstance(node, Function)}


@cache
def imported(tree: ast.Module) -> dict[str, tuple[Path, str]]:
    """Return file and name of what a module takes from other modules of the tests."""
    return {
        name.asname or name.name: (ROOT / (node.module.replace(".", "/") + ".py"), name.name)
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module is not None and node.module.startswith("tests.")
        for name in node.names
    }


def called_name(call: ast.Call) -> str:
    return call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")


def is_expectation(call: ast.Call) -> bool:
    """Whether it is Playwright's way to assert what a browser shows: `expect(locator).to_be_visible()`."""
    subject = call.func.value if isinstance(call.func, ast.Attribute) else None
    return isinstance(subject, ast.Call) and called_name(subject) == "expect" and "to_" in called_name(call)


def is_assertion(node: ast.AST) -> bool:
    if isinstance(node, ast.Call):
        return called_name(node) in RAISING or called_name(node).startswith("assert_") or is_expectation(node)
    return isinstance(node, ast.Assert)


def asserts(function: Function, tree: ast.Module, seen: frozenset[str] = frozenset()) -> bool:
    """Whether a function has an assertion, or calls a function of the tests that has one."""
    nodes = list(ast.walk(function))
    if any(map(is_assertion, nodes)):
        return True
    called = {node.func.id for node in nodes if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)}
    own, others = functions(tree), imported(tree)
    for name in called - seen:
        if name in own and asserts(own[name], tree, seen | {name}):
            return True
        if name in others:
            path, original = others[name]
            there = parsed(path) if path.is_file() else ast.Module([], [])
            if original in functions(there) and asserts(functions(there)[original], there, seen | {name}):
                return True
    return False


def without_assertion(tree: ast.Module) -> Iterator[Function]:
    """Yield the tests of a module, those in classes too, that assert nothing."""
    for node in ast.walk(tree):
        if isinstance(node, Function) and node.name.startswith("test_") and not asserts(node, tree):
            yield node


def test_every_test_asserts_something() -> None:
    found = [
        f"{path.relative_to(ROOT)}:{test.lineno} {test.name}"
        for path in FILES
        for test in without_assertion(parsed(path))
    ]
    assert found == []


@pytest.mark.parametrize(
    "source",
    [
        "def test_a(): f()",
        "async def test_a(): await f()",
        "class TestA:\n    def test_a(self): f()",
        "def f(): g()\ndef g(): f()\ndef test_a(): f()",
        "from tests.waiting import let_others_run\ndef test_a(): let_others_run()",
    ],
)
def test_a_test_without_an_assertion_is_found(source: str) -> None:
    assert [test.name for test in without_assertion(ast.parse(source))] == ["test_a"]


@pytest.mark.parametrize(
    "source",
    [
        "def test_a(): assert f()",
        "def test_a():\n    with pytest.raises(ValueError): f()",
        "def test_a(): np.testing.assert_allclose(f(), 1)",
        "def test_a(): expect(page.locator('p')).not_to_be_visible()",
        "def f(): assert 1\ndef g(): f()\ndef test_a(): g()",
        "from tests.waiting import wait_until as wait\ndef test_a(): wait(f)",
    ],
)
def test_an_assertion_is_found_in_the_test_or_in_what_it_calls(source: str) -> None:
    assert list(without_assertion(ast.parse(source))) == []
