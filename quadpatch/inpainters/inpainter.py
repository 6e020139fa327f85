"""What every inpainter does: fit itself to the mesh at hand, then predict whole height maps from their known bins.

Tested in `tests/quadpatch/inpainters/test_dictionary.py`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, Protocol, runtime_checkable

from quadpatch.calibration.training_pairs import TrainingPairs, TrainingSurface
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
    held_out : callable or None
        Returns pairs of the calibration holes, which nothing is learned from; None without any.
    """

    patches: Patches
    base_heights: FloatArray
    training_surface: Callable[[], TrainingSurface]
    held_out: Callable[[], TrainingPairs] | None = None


# Why fitting ended: all `steps` were done; the error of the calibration holes `settled`; it never became less
# (`no_gain`); the `seconds` were over; there is `no_room` for training pairs; or there is `no_calibration`, without
# which no model is believed.
FittingEnd = Literal["steps", "settled", "no_gain", "seconds", "no_room", "no_calibration"]


@dataclass(frozen=True)
class Fitting:
    """How a network was fitted to the mesh at hand.

    Attributes
    ----------
    steps_asked, steps : int
        At most allowed, and done.
    end : str
        See `FittingEnd`.
    training_pairs : int
    held_out_before, held_out_after : float or None
        Error on calibration holes before, and with the weights that were kept, in standard deviations; None where it
        was not measured. Equal where no fitted weights were better than those before.
    """

    steps_asked: int
    steps: int
    end: FittingEnd
    training_pairs: int = 0
    held_out_before: float | None = None
    held_out_after: float | None = None


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


@runtime_checkable
class TellsOfFitting(Protocol):
    """A fitted inpainter that was trained on the mesh at hand."""

    @property
    def fitting(self) -> Fitting | None:
        """How that went."""
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
