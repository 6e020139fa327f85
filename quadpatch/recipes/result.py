"""What comes out of a repair: of each hole, of the model, and as a whole.

Tested in `tests/quadpatch/recipes/test_assessment.py`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from quadpatch.calibration.energy_selection import EnergyBlend
from quadpatch.calibration.error_model import ErrorModel
from quadpatch.calibration.record import CalibrationRecord
from quadpatch.filling.bridges import Bridge
from quadpatch.filling.fairing import Energy
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.inpainters.inpainter import Fitting
from quadpatch.mesh.holes import Hole
from quadpatch.patches.scale import PatchScale
from quadpatch.types import BoolArray, FloatArray


@dataclass(frozen=True, slots=True)
class HoleResult:
    """What became of one hole. Lengths in mesh units.

    Attributes
    ----------
    verdict : str
        `filled` by the model, `filled_smooth` by geometry alone, `skipped` by rule, `refused` as impossible.
    code, reason : str
        Why, for programs and for people; empty for `filled`.
    confidence : float or None
        0..1, by the expected error in relation to the object's size; None where nothing was filled.
    expected_error : float or None
        Expected mean distance of the fill to the true surface.
    measures : dict
        What the verdict rests on; `folds` and `crossings` count the faults that the check left.
    fill : str
        Which geometric fill carries it: `energies` (what suits the surface), `creases` (the same with the creases of
        the surface around it), `flat` (a plane patch), or a plainer one, `thin_plate` or `constrained`, where others
        fold or run through other surface. Empty where nothing was filled.
    energies : sequence of (Energy, float)
        Where the fill is `energies` or `creases`: which ones, each with its share.
    bridge : Bridge or None
        The one that joins this loop to another; its vertices and triangles count with the first of the two.
    """

    hole: Hole
    verdict: str
    code: str = ""
    reason: str = ""
    confidence: float | None = None
    expected_error: float | None = None
    n_new_vertices: int = 0
    n_new_triangles: int = 0
    measures: dict[str, float] = field(default_factory=dict)
    fill: str = ""
    energies: Sequence[tuple[Energy, float]] = ()
    bridge: Bridge | None = None


@dataclass(frozen=True)
class PatchAgreement:
    """What the patches said about every hole, (n_holes,) float64 each, by position in the list of loops.

    Attributes
    ----------
    coverage : share of the hole's new vertices that a patch sees
    deviation : mean standard deviation between patches, mesh units
    departure : mean length of the displacement, mesh units
    rim_misfit : mean error of the model at the rim, where the truth is known, mesh units
    """

    coverage: FloatArray
    deviation: FloatArray
    departure: FloatArray
    rim_misfit: FloatArray


@dataclass(frozen=True)
class Trial:
    """What calibration says of one of the models that competed, or of the mean of several.

    Attributes
    ----------
    shares : dict of str to float
        Of the models, by name; empty for geometry alone.
    blend_factor : float
        Share of what they predict that is best, 0..1; 0 where geometry alone does as well.
    error : float
        Mean error of the calibration holes with that share, in mesh units.
    n_holes : int
        How many of the calibration holes it was tried on: a model that gains nothing on the first few is dropped.
    """

    shares: dict[str, float]
    blend_factor: float
    error: float
    n_holes: int


@dataclass(frozen=True)
class Completion:
    """What a model says of the fill.

    Attributes
    ----------
    displacement : (n_invented_vertices, 3) float64
        Of the fill's new vertices, in mesh units; 0 in holes that are not displaced.
    agreement : PatchAgreement or None
        None where the blend factor is 0, and the model was not asked.
    displaced_holes : (n_holes,) bool
        Holes that were displaced.
    blend_factor : float
        Share of the displacement that was applied, 0..1, as calibration on this mesh sets it.
    error_model : ErrorModel or None
        How large an error to expect, by calibration holes; None without calibration.
    scale : PatchScale
    n_patches : int
        That the model completed.
    shares : dict of str to float
        Of the models that competed, by name; empty where there was one, or none was applied.
    trials : sequence of Trial
        Of geometry and the models that competed; empty where there was one, or no calibration.
    undone : (n_holes,) bool or None
        Holes whose displacement was taken back, since it made their fill fold or run through other surface.
    left_out : (n_holes,) bool or None
        Holes that a rule keeps the model out of.
    fitting : Fitting or None
        How a network was fitted to the mesh; None where none was.
    """

    displacement: FloatArray
    agreement: PatchAgreement | None
    displaced_holes: BoolArray
    blend_factor: float
    error_model: ErrorModel | None
    scale: PatchScale
    n_patches: int
    shares: dict[str, float] = field(default_factory=dict)
    trials: Sequence[Trial] = ()
    undone: BoolArray | None = None
    left_out: BoolArray | None = None
    fitting: Fitting | None = None

    def apply(self, filled: FilledMesh) -> FilledMesh:
        """Displace the fill."""
        return filled.displaced(self.displacement) if self.displaced_holes.any() else filled

    def limited_to(self, holes: BoolArray, filled: FilledMesh) -> "Completion":
        """Take the displacement back in all but some holes (n_holes,) of the fill."""
        displacement = np.where(holes[filled.vertex_hole][:, None], self.displacement, 0.0)
        return replace(self, displacement=displacement, displaced_holes=self.displaced_holes & holes)


@dataclass(frozen=True)
class Repair:
    """The repaired mesh, and how it came to be.

    Attributes
    ----------
    filled : FilledMesh
        Measured vertices and triangles first, bit for bit.
    chosen : list of Hole
        In the order of the filled loops.
    results : list of HoleResult
        One per hole, by id.
    blend : EnergyBlend
        What the fill was faired by.
    completion : Completion or None
        None where geometry alone filled the holes.
    warnings : list of str
    calibration : CalibrationRecord or None
        None where the recipe has none.
    is_calibration_reused : bool
        Whether an earlier repair has found it out.
    """

    filled: FilledMesh
    chosen: list[Hole]
    results: list[HoleResult]
    blend: EnergyBlend
    completion: Completion | None
    warnings: list[str]
    calibration: CalibrationRecord | None = None
    is_calibration_reused: bool = False
