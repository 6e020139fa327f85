"""What every inpainter does: fit itself to the mesh at hand, then predict whole height maps from their known bins.

Tested in `tests/quadpatch/inpainters/test_dictionary.py`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from quadpatch.calibration.training_pairs import TrainingSurface
from quadpatch.types import FloatArray, Patches


@dataclass(frozen=True)
class UndamagedSurface:
    """Undamaged surface of the mesh at hand, for a model to be fitted to.

    Attributes
    ----------
    patches : Patches
        Calibration holes count as unknown.
    base_heights : (n_patches, N, N) float64
    training_surface : callable
        Returns the same surface to cut training pairs from; calibration holes are open.
    """

    patches: Patches
    base_heights: FloatArray
    training_surface: Callable[[], TrainingSurface]


class FittedInpainter(Protocol):
    """Predicts heights. `resolution` is what its patches must have."""

    @property
    def resolution(self) -> int:
        """Bins along one side of its patches."""
        ...

    def predict(self, patches: Patches, base_heights: FloatArray) -> FloatArray:
        """Predict every bin, the known ones too: how well it does there says how far to trust it elsewhere.

        Parameters
        ----------
        patches : Patches
            Heights in unknown bins are those of the geometric fill.
        base_heights : (n_patches, N, N) float64
            Heights of the smoothed surface in the same patches.

        Returns
        -------
        (n_patches, N, N) float64
            Heights in mesh units.
        """
        ...


class Inpainter(Protocol):
    """A model that a repair is asked for."""

    @property
    def resolution(self) -> int | None:
        """Bins along one side of its patches; None for one that is learned from the mesh alone, with any."""
        ...

    def fitted_to(self, undamaged: UndamagedSurface) -> FittedInpainter | None:
        """Fit the model to the mesh at hand; itself where there is nothing to fit.

        Returns
        -------
        FittedInpainter or None
            None where the surface shows too little to learn a model from.
        """
        ...
