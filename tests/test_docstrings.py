"""Docstrings name the parameters and attributes that are there."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = (
    "quadpatch",
    "jobkit",
    "service",
    "worker",
    "dispatcher",
    "training",
    "client",
    "onebox",
    "benchmarks",
    "deploy",
)
FILES = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.py"))


def section(docstring: str, title: str) -> list[str]:
    """Return the names that a section of a docstring in numpy's style explains."""
    body = re.search(rf"^{title}\n-+\n((?:.*\n?)*?)(?=^\w.*\n-{{3,}}$|\Z)", docstring, re.MULTILINE)
    heads = re.findall(r"^(\S[^:\n]*?) : ", body[1], re.MULTILINE) if body else []
    return [name.strip().lstrip("*") for head in heads for name in head.split(",")]


def stale_names(tree: ast.Module) -> Iterator[str]:
    """Yield what docstrings explain and the code does not have."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield from _missing(node, "Parameters", _parameters(node))
        elif isinstance(node, ast.ClassDef):
            yield from _missing(node, "Attributes", _attributes(node))
            made_by = [item for item in node.body if isinstance(item, ast.FunctionDef) and item.name == "__init__"]
            if made_by:
                yield from _missing(node, "Parameters", _parameters(made_by[0]))


def _missing(node: ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef, title: str, known: set[str]) -> Iterator[str]:
    names = section(ast.get_docstring(node) or "", title)
    yield from (f"{node.name}: {name}" for name in names if name not in known)


def _parameters(node: ast.FunctionDef | ast.AsyncFunctionDef) -> set[str]:
    arguments = node.args
    named = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg]
    return {argument.arg for argument in named if argument is not None}


def _attributes(node: ast.ClassDef) -> set[str]:
    found = {
        item.target.id for item in node.body if isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name)
    }
    found |= {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
    return found | {
        item.attr for item in ast.walk(node) if isinstance(item, ast.Attribute) and isinstance(item.ctx, ast.Store)
    }


def test_docstrings_explain_what_is_there() -> None:
    found = [
        f"{path.relative_to(ROOT)}: {name}"
        for path in FILES
        for name in stale_names(ast.parse(path.read_text("utf-8")))
    ]
    assert found == []


@pytest.mark.parametrize(
    "source",
    [
        'class A:\n    """A.\n\n    Attributes\n    ----------\n    old : int\n    """\n\n    new: int\n',
        'def f(new: int) -> None:\n    """F.\n\n    Parameters\n    ----------\n    new, old : int\n    """\n',
    ],
)
def test_a_name_that_is_gone_is_found(source: str) -> None:
    assert [name.split(": ")[1] for name in stale_names(ast.parse(source))] == ["old"]
