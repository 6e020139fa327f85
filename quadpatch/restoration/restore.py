"""Positions for vertices that are known to be missing; what was measured stays.

The connectivity of the mesh is known. Geometry places the missing vertices in several ways, some measured vertices are
hidden and restored with them, and the way that leaves those closest to the surface is taken. A dictionary of patches
then says where the vertices lie off, and is believed as far as that brings the hidden ones closer.

References
----------
K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019, section 5.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, get_args

import numpy as np

from quadpatch.errors import NoQuadsError, OptionError, StageError
from quadpatch.inpainters.inpainter import Inpainter
from quadpatch.options import PatchOptions, built, check_length_unit, check_seed
from quadpatch.restoration.expected_error import learn_error_curve
from quadpatch.restoration.hidden_vertices import Trial, hide
from quadpatch.restoration.least_squares import within_reach
from quadpatch.restoration.patch_detail import PatchDetail, continue_detail
from quadpatch.restoration.placements import EDGE_NORMALS, LEAST_SQUARES, SMOOTH_NORMALS, placements, poisson_base
from quadpatch.stages import Stages
from quadpatch.types import BoolArray, FloatArray, TriangleMesh, Triangles, Vertices
from quadpatch_rules.coded_warnings import warning
from quadpatch_rules.option_words import LengthUnit

# Where the measured vertices are too few to hide some of them.
PRIOR_PLACEMENT = SMOOTH_NORMALS
# Shares of what patches say that are tried on hidden vertices.
BLEND_FACTORS = (0.25, 0.5, 0.75, 1.0)
# What a share must gain on the hidden vertices to be believed.
LEAST_GAIN = 0.02

Base = Literal["mesh", "poisson"]


@dataclass(frozen=True)
class RestoreOptions:
    """Everything that a restoration can be told.

    Attributes
    ----------
    patches : PatchOptions
    seed : int
        Starts every random choice.
    base : str
        `mesh`: the mesh's own connectivity says where missing vertices lie; `poisson`: a screened Poisson surface of
        the measured vertices is tried as well.
    length_unit : str, optional
        Unit of the scan's coordinates, where its file states none.
    """

    patches: PatchOptions = field(default_factory=PatchOptions)
    seed: int = 0
    base: Base = "mesh"
    length_unit: LengthUnit | None = None

    def __post_init__(self) -> None:
        check_seed(self.seed)
        check_length_unit(self.length_unit)
        if self.base not in get_args(Base):
            raise OptionError(f"base must be one of {', '.join(get_args(Base))}; it is {self.base!r}")

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> "RestoreOptions":
        """Build from nested plain values; an unknown name raises OptionError."""
        return built(cls, values, patches=PatchOptions)


@dataclass(frozen=True)
class Restoration:
    """A mesh whose missing vertices have positions.

    Attributes
    ----------
    vertices : (n, 3) float64
        Measured ones with their bits; those out of reach as they came.
    restored, out_of_reach : (n,) bool
        Missing vertices that got a position, and those in pieces without a measured vertex, which got none.
    expected_error : (n,) float64
        Root mean square distance to the true surface that is expected of each vertex, in mesh units; 0 where measured,
        NaN where that could not be learned.
    placement : str
        The way that was chosen, see `quadpatch.restoration.placements`.
    trials : dict
        Root mean square distance of the hidden vertices to the surface, by the way, in mesh units; empty without any.
    blend_factor : float
        Share of what patches say that was believed.
    n_hidden : int
    detail : PatchDetail or None
        None where no patch was asked, or none believed.
    warnings : list of str
    """

    vertices: Vertices
    restored: BoolArray
    out_of_reach: BoolArray
    expected_error: FloatArray
    placement: str
    trials: dict[str, float]
    blend_factor: float = 0.0
    n_hidden: int = 0
    detail: PatchDetail | None = None
    warnings: list[str] = field(default_factory=list)


def restore(
    mesh: TriangleMesh,
    missing: BoolArray,
    inpainter: Inpainter | None = None,
    options: RestoreOptions | None = None,
    stages: Stages | None = None,
    coarse: TriangleMesh | None = None,
) -> Restoration:
    """Give positions to the missing vertices of a mesh.

    Parameters
    ----------
    mesh : TriangleMesh
        Positions of missing vertices are never read.
    missing : (n,) bool
    inpainter : Inpainter, optional
        None restores by geometry alone.
    options : RestoreOptions, optional
    stages : Stages, optional
        Gets progress and seconds.
    coarse : TriangleMesh, optional
        A surface known from elsewhere, such as a coarse mesh of the same object; tried as a way of its own.

    Returns
    -------
    Restoration

    Raises
    ------
    StageError
        If no missing vertex is connected to a measured one.
    """
    options, stages = options or RestoreOptions(), stages or Stages()
    reachable = within_reach(mesh.triangles, missing)
    if not reachable.any():
        raise StageError("no missing vertex is connected to a measured one: nothing says where it lies")
    # Whatever stands in place of a missing position is not read, not even as a number.
    triangles = mesh.triangles[~(missing & ~reachable)[mesh.triangles].any(axis=1)]
    clean = TriangleMesh(np.where(missing[:, None], 0.0, mesh.vertices), triangles)
    with stages.stage("fill"):
        hidden = hide(triangles, reachable, np.random.default_rng(options.seed))
        concealed = reachable if hidden is None else hidden.with_missing(reachable)
        base = poisson_base(clean, concealed) if coarse is None and options.base == "poisson" else coarse
        placed = placements(clean, reachable, base)
        trial = None if hidden is None else Trial(hidden, concealed, placements(clean, concealed, base))
    with stages.stage("judge"):
        chosen = _chosen(clean, placed, trial)
    if trial is not None and inpainter is not None:
        chosen = _with_detail(clean, reachable, chosen, inpainter, options, stages)
    with stages.stage("judge"):
        expected = _expected_error(chosen, placed, triangles)
    vertices = np.where(reachable[:, None], chosen.vertices, mesh.vertices)
    return Restoration(
        vertices,
        reachable,
        missing & ~reachable,
        np.where(reachable, expected, 0.0),
        chosen.placement,
        chosen.trials,
        chosen.blend_factor,
        0 if trial is None else len(trial.hidden.vertices),
        chosen.detail,
        chosen.warnings,
    )


@dataclass(frozen=True)
class _Choice:
    """What was chosen so far; `tried` are the vertices of the trial, restored in the same way."""

    vertices: Vertices
    placement: str
    trials: dict[str, float]
    trial: Trial | None
    tried: Vertices
    blend_factor: float = 0.0
    detail: PatchDetail | None = None
    warnings: list[str] = field(default_factory=list)


def _chosen(mesh: TriangleMesh, placed: dict[str, Vertices], trial: Trial | None) -> _Choice:
    """Take the way that leaves the hidden vertices closest to the surface."""
    if trial is None:
        warnings: list[str] = [warning("expected_error_unknown")]
        return _Choice(placed[PRIOR_PLACEMENT], PRIOR_PLACEMENT, {}, None, mesh.vertices, warnings=warnings)
    rms = {
        way: trial.rms(trial.errors(trial.placed[way], TriangleMesh(vertices, mesh.triangles)))
        for way, vertices in placed.items()
    }
    best = min(rms, key=lambda way: rms[way])
    return _Choice(placed[best], best, rms, trial, trial.placed[best])


def _with_detail(
    mesh: TriangleMesh,
    missing: BoolArray,
    chosen: _Choice,
    inpainter: Inpainter,
    options: RestoreOptions,
    stages: Stages,
) -> _Choice:
    """Let patches displace the vertices, as far as that brings the hidden ones closer."""
    trial = chosen.trial
    assert trial is not None
    surface = TriangleMesh(chosen.vertices, mesh.triangles)
    try:
        tried = continue_detail(
            TriangleMesh(chosen.tried, mesh.triangles), trial.missing, inpainter, options.patches, stages
        )
        if tried is None:
            return _warned(chosen, warning("too_little_surface_to_restore"))
        rms = {
            factor: trial.rms(trial.errors(chosen.tried + factor * tried.moves, surface)) for factor in BLEND_FACTORS
        }
        factor = min(rms, key=lambda factor: rms[factor])
        trials = {**chosen.trials, "patches": rms[factor]}
        if rms[factor] > (1 - LEAST_GAIN) * chosen.trials[chosen.placement]:
            return replace(chosen, trials=trials)
        detail = continue_detail(surface, missing, inpainter, options.patches, stages)
    except NoQuadsError as error:
        return _warned(chosen, warning("no_patches_to_restore", reason=str(error)))
    if detail is None:
        return replace(chosen, trials=trials)
    return replace(
        chosen,
        vertices=chosen.vertices + factor * detail.moves,
        tried=chosen.tried + factor * tried.moves,
        trials=trials,
        blend_factor=factor,
        detail=detail,
    )


def _warned(chosen: _Choice, sentence: str) -> _Choice:
    return replace(chosen, warnings=[*chosen.warnings, sentence])


def _expected_error(chosen: _Choice, placed: dict[str, Vertices], triangles: Triangles) -> FloatArray:
    """Give expected errors (n,) of all vertices: NaN without a trial."""
    trial = chosen.trial
    if trial is None:
        return np.full(len(chosen.vertices), np.nan)
    hidden = trial.hidden.vertices
    errors = trial.errors(chosen.tried, TriangleMesh(chosen.vertices, triangles))
    curve = learn_error_curve(_disagreement(trial.placed)[hidden], errors, trial.hidden.weight)
    return curve.expected(_disagreement(placed))


def _disagreement(placed: dict[str, Vertices]) -> FloatArray:
    """Distances (n,) between the smoothest way to place a vertex and the one that keeps edges, in mesh units."""
    return np.asarray(np.linalg.norm(placed[EDGE_NORMALS] - placed[LEAST_SQUARES], axis=1))
