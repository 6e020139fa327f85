"""Which options of a job exclude each other.

They are looked at where a job is made, and are no part of reading a spec: jobs that were stored before a rule came up
are still read.

Tested in `tests/quadpatch_client/schema/test_tasks.py`.
"""

from collections.abc import Mapping

from quadpatch_client.schema.methods import (
    SELF,
    AutoMethod,
    CnnMethod,
    DictionaryMethod,
    DictionarySize,
    Fitting,
    PatchOptions,
    SmoothMethod,
)
from quadpatch_client.schema.spec import HoleSelection, RepairSpec
from quadpatch_rules.hole_selection import MODEL_FILLS_ONLY, names_fills
from quadpatch_rules.tasks import TRAIN, Task

# The field of a spec that holds the options of a task; `fill` has fields of its own, `decode` has no options.
OPTIONS_OF_TASKS = {"restore": "restore", "denoise": "denoise", "encode": "encode"}
# The methods that a task takes.
_METHODS: Mapping[Task, tuple[str, ...]] = {
    "restore": ("dictionary", "cnn", "smooth"),
    "denoise": ("dictionary", "smooth"),
    "encode": ("dictionary",),
    "decode": ("dictionary",),
}
# What such a task can't do without.
_REQUIRED = {"restore": "restore.missing", "encode": "encode.max_error"}


def conflict_of(spec: RepairSpec) -> str | None:
    """Say in a sentence which options of a job exclude each other, or which one is missing; None where none does."""
    if spec.task == TRAIN or getattr(spec, TRAIN, None) is not None:
        return "the task train needs several meshes: start it by POST /v1/trainings"
    return _conflict_of_fill(spec) if spec.task == "fill" else _conflict_of_task(spec)


def _conflict_of_fill(spec: RepairSpec) -> str | None:
    if spec.weld_tolerance != "auto" and any(rule.ids is not None for rule in spec.holes.rules):
        return "ids of holes.rules name holes found with the weld_tolerance auto: drop one of the two"
    if isinstance(spec.method, SmoothMethod):
        return _options_of_another_task(spec)
    if isinstance(spec.method, AutoMethod):
        return (
            _conflict_of_effort(spec.method)
            or _conflict_of_patches(spec.method.patches)
            or _options_of_another_task(spec)
        )
    if spec.method.recipe == "paper" and names_fills(spec.holes):
        return MODEL_FILLS_ONLY
    if spec.method.recipe == "paper" and isinstance(spec.method, CnnMethod) and spec.method.model == SELF:
        return "the recipe paper fits no network to a mesh: leave method.recipe out, or take another model"
    return (
        _conflict_of_learning(spec.method)
        or _conflict_of_patches(spec.method.patches)
        or _options_of_another_task(spec)
    )


def _conflict_of_learning(method: DictionaryMethod | CnnMethod) -> str | None:
    """Say what is wrong with what a dictionary is to be learned from, or with its size."""
    if not isinstance(method, DictionaryMethod):
        return None
    if method.learn_from is not None and (method.model != SELF or method.recipe != "default"):
        return "method.learn_from goes with the model self and the recipe default"
    if method.dictionary != DictionarySize() and (method.model != SELF or method.recipe != "paper"):
        return "method.dictionary goes with the model self and the recipe paper"
    return None


def _conflict_of_task(spec: RepairSpec) -> str | None:
    return (
        _options_of_another_task(spec)
        or _options_of_fill(spec)
        or _missing_option(spec)
        or _conflict_of_method(spec)
        or _conflict_of_output(spec)
    )


def _conflict_of_effort(method: AutoMethod) -> str | None:
    if method.effort != "best" and method.fitting != Fitting():
        return "method.fitting goes with the effort best: drop it, or ask for that effort"
    return None


def _conflict_of_patches(patches: PatchOptions) -> str | None:
    if patches.preset is not None and (patches.length is not None or patches.resolution is not None):
        return "method.patches.preset says length and resolution: drop it, or drop these"
    return None


def _options_of_another_task(spec: RepairSpec) -> str | None:
    for task, name in OPTIONS_OF_TASKS.items():
        if task != spec.task and getattr(spec, name) is not None:
            return f"{name} holds options of the task {task}; the task of this job is {spec.task}"
    return None


def _options_of_fill(spec: RepairSpec) -> str | None:
    given = {
        "holes": spec.holes != HoleSelection(),
        "weld_tolerance": spec.weld_tolerance != "auto",
        "colours": spec.colours != "auto",
        "output.closeups": spec.output.closeups,
        "output.tint": spec.output.tint != "invented",
        "output.attributes": spec.output.attributes is not None,
        "rule": spec.rule is not None,
        "acceptance": spec.acceptance is not None,
    }
    name = next((name for name, is_given in given.items() if is_given), None)
    return None if name is None else f"{name} goes with the task fill; the task of this job is {spec.task}"


def _missing_option(spec: RepairSpec) -> str | None:
    name = OPTIONS_OF_TASKS.get(spec.task)
    if spec.task in _REQUIRED and name is not None and getattr(spec, name) is None:
        return f"the task {spec.task} needs {_REQUIRED[spec.task]}"
    return None


def _conflict_of_method(spec: RepairSpec) -> str | None:
    method = spec.method
    if method.method not in _METHODS[spec.task]:
        return f"the task {spec.task} goes by {' or '.join(_METHODS[spec.task])}, not by the method {method.method}"
    if isinstance(method, CnnMethod) and method.model == SELF:
        return "a network can't be fitted to a mesh whose vertices are missing: name a model other than self"
    has_reference = spec.denoise is not None and spec.denoise.reference is not None
    if has_reference and not (isinstance(method, DictionaryMethod) and method.model == SELF):
        return "denoise.reference takes the place of a model: leave method out, or say self"
    return None if isinstance(method, SmoothMethod | AutoMethod) else _conflict_of_learned(spec, method)


def _conflict_of_learned(spec: RepairSpec, method: DictionaryMethod | CnnMethod) -> str | None:
    if isinstance(method, DictionaryMethod):
        given = {
            "learn_from": method.learn_from is not None,
            "dictionary": method.dictionary != DictionarySize(),
        }
        name = next((name for name, is_given in given.items() if is_given), None)
        if name is not None:
            return f"method.{name} goes with the task fill; the task of this job is {spec.task}"
    if method.recipe != "default":
        return f"recipes go with the task fill; the task of this job is {spec.task}"
    if spec.task == "encode" and method.patches.overlap is not None:
        return "patches of the task encode share their borders: leave method.patches.overlap out"
    return _conflict_of_patches(method.patches)


def _conflict_of_output(spec: RepairSpec) -> str | None:
    if spec.task == "encode" and spec.output.format is not None:
        return "the task encode hands back a .qpz file: leave output.format out"
    return None
