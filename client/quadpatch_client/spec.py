"""How the options of a command become a job spec.

Tested in `tests/quadpatch_client/test_options.py`.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TypeVar

from pydantic import ValidationError

from quadpatch_client.errors import UsageError
from quadpatch_client.options import HoleChoice, MethodChoice
from quadpatch_client.schema import SELF, JobSpec, conflict_of
from quadpatch_client.wording import said
from quadpatch_rules.rule_text import RuleTextError, read_bridge, read_rule

Value = TypeVar("Value")


def make_spec(mesh_id: str, holes: HoleChoice, method: MethodChoice, **rest: Any) -> JobSpec:
    """Build a job spec from what was given; the service fills in the defaults of what was not.

    Raises
    ------
    UsageError
        If an option is out of its range, or does not go with the method or with another option.
    """
    chosen = _given({**vars(holes), "rules": _rules(holes.rules), "bridges": _bridges(holes.bridges)})
    values = {"mesh_id": mesh_id, "holes": chosen, **_given({"method": _method(method)}), **_given(rest)}
    with in_words():
        spec = JobSpec.model_validate(values)
    conflict = conflict_of(spec)
    if conflict is not None:
        raise UsageError(conflict)
    return spec


@contextmanager
def in_words() -> Iterator[None]:
    """Turn what validation finds into a UsageError in the words of the command line."""
    try:
        yield
    except ValidationError as error:
        raise UsageError(said(error)) from error


def _method(choice: MethodChoice) -> dict[str, Any]:
    patches = _given({name: getattr(choice, name) for name in ("length", "resolution", "overlap", "preset")})
    fitting = _given({"steps": choice.fit_steps, "seconds": choice.fit_seconds})
    if choice == MethodChoice():
        return {}  # the service has a default of its own for each task
    method = choice.method or ("auto" if choice.model is choice.recipe is None else "dictionary")
    if method == "auto":
        return _auto(choice, patches, fitting)
    if choice.effort is not None:
        raise UsageError(f"an effort goes with the method 'auto' alone, not with '{method}'")
    if fitting and (method, choice.model) != ("cnn", SELF):
        raise UsageError("only the effort 'best' and the method 'cnn' with the model 'self' fit a network")
    if method == "smooth":
        if choice.model is not None or choice.recipe is not None or patches:
            raise UsageError("the method 'smooth' takes no model, no recipe and no patch options")
        return {"method": "smooth"}
    rest = _given({"model": choice.model, "recipe": choice.recipe, "fitting": fitting})
    return {"method": method, "patches": patches, **rest}


def _auto(choice: MethodChoice, patches: dict[str, Any], fitting: dict[str, Any]) -> dict[str, Any]:
    if choice.model is not None or choice.recipe is not None:
        raise UsageError("the method 'auto' finds the model by itself: name another method for a model or a recipe")
    if fitting and choice.effort != "best":
        raise UsageError("of the efforts, only 'best' fits a network; the others take no time to fit")
    return _given({"method": "auto", "effort": choice.effort, "patches": patches, "fitting": fitting})


def _given(values: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if value not in (None, [], {})}


def _rules(texts: Sequence[str] | None) -> list[dict[str, Any]]:
    return _read(texts, read_rule)


def _bridges(texts: Sequence[str] | None) -> list[list[int]]:
    return [list(pair) for pair in _read(texts, read_bridge)]


def _read(texts: Sequence[str] | None, read: Callable[[str], Value]) -> list[Value]:
    try:
        return [read(text) for text in texts or ()]
    except RuleTextError as error:
        raise UsageError(str(error)) from error
