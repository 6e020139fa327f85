"""What a job would do: its selection, applied to the hole list that a worker found."""

from jobkit.errors import UnknownHoleError
from jobkit.schema import DictionaryMethod, HoleSelection, JobSpec, Limits, MeshFacts, Plan, PlannedHole, ResolvedModel
from jobkit.settings import Settings
from service.hole_selection import choose_holes, join_islands


def make_plan(spec: JobSpec, facts: MeshFacts, model: ResolvedModel, settings: Settings) -> Plan:
    """Apply a job's spec to what is known of its mesh.

    Raises
    ------
    UnknownHoleError
        If an explicit id names no hole.
    """
    check_hole_ids(spec.holes, facts)
    choices = choose_holes(facts.holes, spec.holes, facts.diagonal)
    if not (isinstance(spec.method, DictionaryMethod) and spec.method.recipe == "paper"):
        choices = join_islands(facts.holes, choices)  # the paper knows no islands
    holes = [
        PlannedHole(**hole.model_dump(), selected=choice.reason is None, **vars(choice))
        for hole, choice in zip(facts.holes, choices, strict=True)
    ]
    limits = Limits(
        time_s=spec.limits.time_s or settings.job_time_limit_s,
        memory_mb=spec.limits.memory_mb or settings.job_memory_limit_mb,
    )
    return Plan(
        mesh_id=spec.mesh_id,
        model=model,
        holes=holes,
        selected=sum(hole.selected for hole in holes),
        limits=limits,
        is_exact=spec.weld_tolerance == "auto",
    )


def check_hole_ids(selection: HoleSelection, facts: MeshFacts) -> None:
    """Raise UnknownHoleError if an explicit id names no hole."""
    named = {i for ids in (selection.ids, *(rule.ids for rule in selection.rules)) for i in ids or ()}
    unknown = sorted(named - {hole.id for hole in facts.holes})
    if unknown:
        raise UnknownHoleError(
            f"no hole has the id {unknown[0]}; this mesh has {len(facts.holes)} holes, counted from 0"
        )
