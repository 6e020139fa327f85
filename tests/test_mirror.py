"""Every module of more than a few lines says where it is tested, by its place or in words.

`quadpatch/mesh/weld.py` is tested by `tests/quadpatch/mesh/test_weld.py`, and `worker/__main__.py` would be by
`tests/worker/test_main.py`. A module that is tested elsewhere ends its docstring with the name of that file, and the
file imports or names the module.
"""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = (
    "client/quadpatch_rules",
    "client/quadpatch_client",
    "quadpatch",
    "jobkit",
    "service",
    "worker",
    "dispatcher",
    "training",
    "onebox",
    "benchmarks",
    "deploy",
)
LONG = 60
MODULES = sorted(str(path.relative_to(ROOT)) for folder in FOLDERS for path in (ROOT / folder).rglob("*.py"))
_WORDS = re.compile(r"Tested in `?(tests/[\w/]+\.py)`?\.\s*\Z")


def mirror_of(module: str) -> str:
    path = Path(module.removeprefix("client/"))
    return str("tests" / path.parent / f"test_{path.stem.strip('_')}.py")


def names_of(module: str) -> list[str]:
    """Return the ways to write a module: its path, its dotted name, and how it is imported from its package."""
    module = module.removeprefix("client/")
    dotted = module.removesuffix(".py").replace("/", ".").removesuffix(".__init__")
    package, _, name = dotted.rpartition(".")
    return [re.escape(module), re.escape(dotted) + r"\b", rf"from {re.escape(package)} import [^\n]*\b{name}\b"]


def fault(module: str, source: str) -> str | None:
    """Say in words what a module lacks; None where it is tested, or too short to need it."""
    stated = _WORDS.search(ast.get_docstring(ast.parse(source)) or "")
    if stated is None:
        is_mirrored = (ROOT / mirror_of(module)).is_file()
        is_short = len(source.splitlines()) <= LONG
        return None if is_mirrored or is_short else f"{module} has no {mirror_of(module)} and names no other test"
    test = ROOT / stated[1]
    if not test.is_file():
        return f"{module} names {stated[1]}, which is not there"
    text = test.read_text("utf-8")
    is_named = any(re.search(name, text) for name in names_of(module))
    return None if is_named else f"{stated[1]} does not name {module}"


def test_every_module_is_tested_beside_it_or_where_it_says() -> None:
    found = [fault(module, (ROOT / module).read_text("utf-8")) for module in MODULES]
    assert [words for words in found if words is not None] == []


BODY = "x = 1\n" * (LONG + 1)


@pytest.mark.parametrize(
    ("module", "source", "message"),
    [
        ("quadpatch/mesh/new.py", f'"""New."""\n{BODY}', "has no tests/quadpatch/mesh/test_new.py"),
        ("quadpatch/new.py", '"""New.\n\nTested in `tests/test_old.py`.\n"""\n', "is not there"),
        ("quadpatch/new.py", '"""New.\n\nTested in tests/test_waits.py.\n"""\n', "does not name quadpatch/new.py"),
    ],
)
def test_a_module_without_a_test_is_found(module: str, source: str, message: str) -> None:
    assert message in (fault(module, source) or "")


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("quadpatch/mesh/weld.py", BODY),
        ("quadpatch/mesh/new.py", "x = 1\n"),
        ("service/__main__.py", BODY),
        ("jobkit/settings.py", f'"""New.\n\nTested in `tests/conftest.py`.\n"""\n{BODY}'),
    ],
)
def test_a_module_with_a_test_or_without_much_to_test_is_left_alone(module: str, source: str) -> None:
    assert fault(module, source) is None
