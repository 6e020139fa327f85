"""What the check of a repair found, put into the results of its holes."""

from dataclasses import replace

import numpy as np

from quadpatch.calibration.energy_selection import EnergyBlend
from quadpatch.filling.bridges import Bridge
from quadpatch.filling.checked_fill import CREASED, CheckedFill
from quadpatch.filling.displaced_fill import displace_without_faults
from quadpatch.filling.fairing import Energy
from quadpatch.filling.faults import Faults, find_faults
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.islands import JoinedRims
from quadpatch.filling.ribs import Ribs
from quadpatch.mesh.holes import Hole
from quadpatch.processes import ProcessPool
from quadpatch.recipes.assessment import confidence, count_new
from quadpatch.recipes.result import Completion, HoleResult, Repair
from quadpatch.types import Triangles

# Energies with a smaller share in a fill are not named.
_LEAST_SHARE = 0.005

_RIB_IN_THE_WAY = "crosses_surface", "the open end of the strip folds, or runs through other surface"
_NO_PLANE_PATCH = "no_plane_patch", "in its plane the rim crosses itself, or encloses no area"


def without_faults(
    completion: Completion | None, checked: CheckedFill, obstacles: Triangles | None, pool: ProcessPool | None = None
) -> tuple[Completion | None, FilledMesh, Faults]:
    """Take the displacement back in holes where it brought in folds or crossings.

    Parameters
    ----------
    completion : Completion or None
    checked : CheckedFill
        The fill before it was displaced.
    obstacles : (k, 3) int64, optional
        Triangles of the file that the mesh leaves out.
    pool : ProcessPool, optional
        Its processes look for crossings.

    Returns
    -------
    completion : Completion or None
    filled : FilledMesh
        The fill, displaced by the completion.
    faults : Faults
        Those that are left.
    """
    if completion is None or not completion.displaced_holes.any():
        return completion, checked.filled, checked.faults
    displaced = displace_without_faults(
        checked.filled, completion.displacement, completion.displaced_holes, checked.faults, obstacles, pool
    )
    if displaced.undone.any():
        completion = replace(completion.limited_to(~displaced.undone, checked.filled), undone=displaced.undone)
    return completion, displaced.filled, displaced.faults


def verified_results(
    results: list[HoleResult],
    rims: JoinedRims,
    checked: CheckedFill,
    blend: EnergyBlend,
    faults: Faults,
    size: float,
) -> list[HoleResult]:
    """Add to every hole's result how it was filled and what the check found.

    Parameters
    ----------
    results : list of HoleResult
        One per hole, by id.
    rims : JoinedRims
    checked : CheckedFill
    blend : EnergyBlend
        What was tried first.
    faults : Faults
        Of the mesh that is handed out.
    size : float
        Diagonal of the object's bounding box, in mesh units.
    """
    verified, counts = list(results), _counts(faults)
    for i, hole in enumerate(rims.chosen):
        result = results[hole.id]
        if i in checked.refused:
            verified[hole.id] = HoleResult(hole, "refused", *checked.refused[i])
        elif result.verdict == "refused" and checked.fill[i] == "flat":
            verified[hole.id] = HoleResult(hole, "refused", *_NO_PLANE_PATCH)
        elif result.verdict.startswith("filled"):
            verified[hole.id] = replace(
                _with_departure(result, checked, i, size),
                fill=checked.fill[i],
                measures={**result.measures, **counts[i]},
                energies=energies_of(i, checked, blend),
            )
    for hole_id, refusal in rims.refused.items():
        verified[hole_id] = HoleResult(results[hole_id].hole, "refused", *refusal)
    for first, bridge in rims.bridges.items():
        verified[first] = replace(verified[first], bridge=bridge)
    return _with_joined(verified, rims)


def _with_joined(results: list[HoleResult], rims: JoinedRims) -> list[HoleResult]:
    """Say of loops that are filled with others what became of those: of islands, and of the far ends of bridges."""
    told = list(results)
    for island, host in rims.host_of.items():
        told[island] = _joined(results[island], results[host])
    for first, bridge in rims.bridges.items():
        told[bridge.holes[1].id] = _at_far_end(bridge, results[first])
    return told


def energies_of(i: int, checked: CheckedFill, blend: EnergyBlend) -> list[tuple[Energy, float]]:
    """Name the energies that one loop is filled by, each with its share; none where a plainer fill took their place."""
    weights = checked.filled.energy_weights
    if weights is None or checked.fill[i] not in {"energies", CREASED}:
        return []
    return [
        (energy, share)
        for energy, share in zip(blend.energies, weights[i].tolist(), strict=True)
        if share >= _LEAST_SHARE
    ]


def _joined(island: HoleResult, host: HoleResult) -> HoleResult:
    """Say of an island what became of the hole that it was joined to: its border is a part of that one's rim."""
    if host.verdict == "refused":
        why = f"an island in hole {host.hole.id}, which was refused: {host.reason}"
        return replace(island, verdict="refused", code=host.code, reason=why)
    why = f"an island in hole {host.hole.id}: the ring between its border and the rim of that hole is filled"
    return replace(island, verdict="filled_smooth", code="joined", reason=why)


def with_ribs(repair: Repair, rims: JoinedRims, ribs: Ribs, obstacles: Triangles | None) -> Repair:
    """Count ribs among what a repair of a whole mesh invented, and refuse the bridges that they spoil."""
    at = {hole.id: position for position, hole in enumerate(rims.chosen)}
    loop_of_bridge = np.array([at[first] for first in rims.bridges], np.int64)
    filled = ribs.told_apart(repair.filled, loop_of_bridge)
    faults = find_faults(filled, np.unique(loop_of_bridge[ribs.triangle_bridge]), obstacles)
    filled = filled.without(np.flatnonzero(faults.is_wrong)) if faults.is_wrong.any() else filled
    results, numbers, counts = list(repair.results), list(zip(*count_new(filled), strict=True)), _counts(faults)
    for first, bridge in rims.bridges.items():
        i, result = at[first], results[first]
        if faults.is_wrong[i]:
            results[first] = HoleResult(result.hole, "refused", *_RIB_IN_THE_WAY, bridge=bridge)
        elif bridge.ribs and result.verdict != "refused":
            measures = {**result.measures, **counts[i]}
            n_vertices, n_triangles = numbers[i]
            results[first] = replace(result, n_new_vertices=n_vertices, n_new_triangles=n_triangles, measures=measures)
    return replace(repair, filled=filled, results=_with_joined(results, rims))


def _at_far_end(bridge: Bridge, result: HoleResult) -> HoleResult:
    """Say of the loop at the far end of a bridge what became of the strip, which counts with the other loop."""
    first, second = bridge.holes
    if result.verdict == "refused":
        why = f"the bridge {first.id}:{second.id} was refused: {result.reason}"
        return HoleResult(second, "refused", result.code, why, bridge=bridge)
    why = f"joined by the bridge {first.id}:{second.id}, whose strip counts with loop {first.id}"
    return HoleResult(second, result.verdict, "bridged", why, bridge=bridge)


def with_named_faults(results: list[HoleResult], chosen: list[Hole], faults: Faults) -> list[HoleResult]:
    """Name the folds and crossings of every filled hole in its measures."""
    found = dict(zip((hole.id for hole in chosen), _counts(faults), strict=True))
    return [
        replace(result, measures={**result.measures, **found[result.hole.id]})
        if result.verdict.startswith("filled") and result.hole.id in found
        else result
        for result in results
    ]


def _counts(faults: Faults) -> list[dict[str, float]]:
    """Count the faults of every loop; in floats, as all measures are."""
    numbers = zip(faults.n_folds.tolist(), faults.crossings.tolist(), strict=True)
    return [{"folds": float(n_folds), "crossings": float(n_crossings)} for n_folds, n_crossings in numbers]


def _with_departure(result: HoleResult, checked: CheckedFill, i: int, size: float) -> HoleResult:
    """Say how large an error to expect where a plane patch or a plainer fill took the place of the first one."""
    if checked.fill[i] == "flat":
        why = "closed by a plane patch, as asked for"
        return replace(result, code="flat", reason=why, confidence=None, expected_error=None)
    departure = float(checked.departure[i])
    if result.expected_error is None or departure <= result.expected_error:
        return result
    # The fill that suits the surface best did not hold: how far the plainer one departs from it is a sign of its error.
    return replace(result, expected_error=departure, confidence=confidence(departure, size))
