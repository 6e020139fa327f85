"""What a job would do: the selection rule, applied to the hole list that a worker found.

The rule is that of `quadpatch.mesh.holes.select_holes`, which this package may not import; a test holds the two
together.
"""

import math

from jobkit.errors import UnknownHoleError
from jobkit.schema import Hole, HoleSelection, JobSpec, Limits, MeshFacts, Plan, PlannedHole, ResolvedModel
from jobkit.settings import Settings

AUTO_DIAMETER_SHARE = 0.25
MAX_NEW_VERTICES = 200_000


def make_plan(spec: JobSpec, facts: MeshFacts, model: ResolvedModel, settings: Settings) -> Plan:
    """Apply a job's spec to what is known of its mesh.

    Raises
    ------
    UnknownHoleError
        If an explicit id names no hole.
    """
    check_hole_ids(spec.holes, facts)
    reasons = [reason_to_skip(hole, spec.holes, facts.diagonal) for hole in facts.holes]
    holes = [
        PlannedHole(**hole.model_dump(), selected=reason is None, reason=reason)
        for hole, reason in zip(facts.holes, reasons, strict=True)
    ]
    limits = Limits(
        time_s=spec.limits.time_s or settings.job_time_limit_s,
        memory_mb=spec.limits.memory_mb or settings.job_memory_limit_mb,
    )
    return Plan(
        mesh_id=spec.mesh_id,
        model=model,
        holes=holes,
        selected=reasons.count(None),
        limits=limits,
        is_exact=spec.weld_tolerance == "auto",
    )


def check_hole_ids(selection: HoleSelection, facts: MeshFacts) -> None:
    """Raise UnknownHoleError if an explicit id names no hole."""
    unknown = sorted(set(selection.ids or ()) - {hole.id for hole in facts.holes})
    if unknown:
        raise UnknownHoleError(
            f"no hole has the id {unknown[0]}; this mesh has {len(facts.holes)} holes, counted from 0"
        )


def reason_to_skip(hole: Hole, selection: HoleSelection, diagonal: float) -> str | None:
    """Return the code of the reason why a hole would stay open, None if it would be filled.

    Parameters
    ----------
    hole : Hole
    selection : HoleSelection
    diagonal : float
        Of the mesh's bounding box, in mesh units.
    """
    is_automatic = selection == HoleSelection()
    max_diameter = AUTO_DIAMETER_SHARE * diagonal if is_automatic else selection.max_diameter
    reasons = (
        (not hole.is_manifold, "non_manifold_rim"),
        (selection.ids is not None and hole.id not in selection.ids, "not_chosen"),
        (selection.all_but_largest and hole.id == 0, "largest"),
        (is_automatic and hole.is_border, "border"),
        (_expected_vertices(hole) > MAX_NEW_VERTICES, "too_many_vertices"),
        (max_diameter is not None and hole.diameter > max_diameter, "too_wide"),
        (selection.max_perimeter is not None and hole.perimeter > selection.max_perimeter, "too_long"),
    )
    return next((code for applies, code in reasons if applies), None)


def _expected_vertices(hole: Hole) -> int:
    edge = hole.perimeter / max(hole.edges, 1)
    return round(hole.area / (math.sqrt(0.75) * edge**2)) if edge > 0 else 0
