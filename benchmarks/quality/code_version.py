"""A hash of the code that results follow from: those of other code are measured again.

Tested in `tests/benchmarks/quality/test_results.py`.
"""

import ast
import hashlib
from collections.abc import Iterable
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@cache
def method_sha256() -> str:
    """Hash of the method's code; comments and docstrings don't count."""
    folders = (ROOT / "quadpatch", ROOT / "client" / "quadpatch_rules")
    return code_sha256(path for folder in folders for path in folder.rglob("*.py"))


def code_sha256(files: Iterable[Path]) -> str:
    """Hash of some files of Python, in the order of their paths; comments and docstrings don't count."""
    return hashlib.sha256("\n".join(_without_docstrings(path) for path in sorted(files)).encode()).hexdigest()


def _without_docstrings(path: Path) -> str:
    tree = ast.parse(path.read_text("utf-8"))
    for node in ast.walk(tree):
        if not isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) or not node.body:
            continue
        first = node.body[0]
        if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
            del node.body[0]
    return f"{path.name} {ast.dump(tree)}"
