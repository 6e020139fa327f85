"""What a job would do: for a fill its selection, applied to the hole list that a worker found."""

from jobkit.errors import UnknownHoleError
from jobkit.settings import Settings
from quadpatch_client.schema import (
    AutoMethod,
    HoleSelection,
    JobSpec,
    Limits,
    MeshFacts,
    Plan,
    PlannedBridge,
    PlannedHole,
    ResolvedModel,
    SmoothMethod,
)
from quadpatch_rules.hole_selection import Choice, choose_holes, join_islands, unknown_hole
from service.plan_summary import summary_of


def make_plan(spec: JobSpec, facts: MeshFacts, model: ResolvedModel, settings: Settings) -> Plan:
    """Apply a job's spec to what is known of its mesh.

    Raises
    ------
    UnknownHoleError
        If an explicit id names no hole.
    """
    check_hole_ids(spec.holes, facts)
    choices = choose_holes(facts.holes, spec.holes, facts.diagonal or 0.0)
    if isinstance(spec.method, SmoothMethod | AutoMethod) or spec.method.recipe != "paper":
        choices = join_islands(
            [hole.lies_in for hole in facts.holes], choices
        )  # the recipe of the paper has no islands
    holes = [
        PlannedHole(
            **hole.model_dump(),
            selected=choice.action is not None,
            reason=choice.code,
            action=choice.action,
            joined_to=choice.joined_to,
            bridged_to=choice.bridged_to,
        )
        for hole, choice in zip(facts.holes, choices, strict=True)
    ]
    n_selected = sum(hole.selected for hole in holes)
    return Plan(
        mesh_id=spec.mesh_id,
        task=spec.task,
        summary=f"fill {n_selected} of {len(holes)} holes",
        model=model,
        holes=holes,
        bridges=_bridges(spec.holes, facts, choices),
        selected=n_selected,
        limits=_limits(spec, settings),
        is_exact=spec.weld_tolerance == "auto",
    )


def _bridges(selection: HoleSelection, facts: MeshFacts, choices: list[Choice]) -> list[PlannedBridge]:
    """List the bridges that are asked for and, behind them, those that are proposed besides."""
    proposed = {frozenset(pair.holes): pair for pair in facts.bridges}
    asked = {frozenset(pair): pair for pair in selection.bridges}
    planned = []
    for ids in dict.fromkeys([*asked, *proposed]):
        found = proposed.get(ids)
        planned.append(
            PlannedBridge(
                holes=asked[ids] if found is None else found.holes,
                selected=ids in asked and all(choices[i].bridged_to is not None for i in ids),
                is_proposed=found is not None,
                **({} if found is None else found.model_dump(include={"shape", "gap", "share"})),
            )
        )
    return planned


def plan_of_task(spec: JobSpec, model: ResolvedModel, settings: Settings) -> Plan:
    """Say what a job would do whose task is not to fill holes: it has no hole list."""
    return Plan(
        mesh_id=spec.mesh_id,
        task=spec.task,
        summary=summary_of(spec),
        model=model,
        holes=[],
        selected=0,
        limits=_limits(spec, settings),
    )


def _limits(spec: JobSpec, settings: Settings) -> Limits:
    return Limits(
        time_s=spec.limits.time_s or settings.job_time_limit_s,
        memory_mb=spec.limits.memory_mb or settings.job_memory_limit_mb,
    )


def check_hole_ids(selection: HoleSelection, facts: MeshFacts) -> None:
    """Raise UnknownHoleError if an explicit id names no hole."""
    message = unknown_hole(facts.holes, selection)
    if message is not None:
        raise UnknownHoleError(message)
