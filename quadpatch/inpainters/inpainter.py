"""What every inpainter does: predict the whole height map of a patch from its known bins."""

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
    training_surface : TrainingSurface
        The same surface to cut training pairs from; calibration holes are open.
    """

    patches: Patches
    base_heights: FloatArray
    training_surface: TrainingSurface


class Inpainter(Protocol):
    """Predicts heights. `resolution` is what its patches must have."""

    @property
    def resolution(self) -> int:
        """Bins along one side of its patches."""
        ...

    def fitted_to(self, undamaged: UndamagedSurface) -> "Inpainter":
        """Fit the model to the mesh at hand; itself where there is nothing to fit."""
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
