"""What every inpainter does: predict the whole height map of a patch from its known bins."""

from typing import Protocol

from quadpatch.types import FloatArray, Patches


class Inpainter(Protocol):
    """Predicts heights. `resolution` is what its patches must have."""

    @property
    def resolution(self) -> int:
        """Bins along one side of its patches."""
        ...

    def fitted_to(self, patches: Patches, outline: FloatArray) -> "Inpainter":
        """Fit the model to the mesh at hand, by undamaged surface of it; itself where there is nothing to fit.

        Parameters
        ----------
        patches : Patches
        outline : (n_patches, N, N) float64
            As for `predict`.
        """
        ...

    def predict(self, patches: Patches, outline: FloatArray) -> FloatArray:
        """Predict every bin, the known ones too: how well it does there says how far to trust it elsewhere.

        Parameters
        ----------
        patches : Patches
            Heights in unknown bins are those of the geometric fill.
        outline : (n_patches, N, N) float64
            Heights of the smoothed surface in the same patches.

        Returns
        -------
        (n_patches, N, N) float64
            Heights in mesh units.
        """
        ...
