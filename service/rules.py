"""A job that names a rule: what the rule says, written into its spec.

Tested in `tests/service/routes/test_rules.py`.
"""

from typing import TypeVar

from jobkit.errors import OptionsConflictError
from jobkit.rules import Rules
from quadpatch_client.schema import RepairSpec, Rule
from quadpatch_rules.tasks import FILL
from service.services import Services

_SAID = ("holes", "method", "colours", "acceptance")


Spec = TypeVar("Spec", bound=RepairSpec)


def with_rule(services: Services, spec: Spec, known: dict[str, Rule] | None = None) -> Spec:
    """Return the spec with what its rule says, pinned to the version that the rule has now.

    Parameters
    ----------
    services : Services
    spec : RepairSpec
    known : dict, optional
        Rules by their references, for many specs; those that are looked up are added.

    Raises
    ------
    RuleNotFoundError
        If there is no such rule.
    OptionsConflictError
        If the spec says something else than the rule.
    """
    if spec.rule is None or spec.task != FILL:
        return spec
    rule = None if known is None else known.get(spec.rule)
    if rule is None:
        rule = Rules(services.database).resolve(spec.rule)
        if known is not None:
            known[spec.rule] = rule
    usual = RepairSpec()
    for name in _SAID:
        if getattr(spec, name) not in (getattr(usual, name), getattr(rule.content, name)):
            raise OptionsConflictError(f"{name} is for the rule {spec.rule} to say: drop one of the two")
    said = {name: getattr(rule.content, name) for name in _SAID}
    return spec.model_copy(update={**said, "rule": f"{rule.name}@{rule.version}"})
