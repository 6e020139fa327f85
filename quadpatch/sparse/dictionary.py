"""A patch dictionary: unit-norm atoms over the bins of a square patch.

Bins are numbered row by row, as ``heights.reshape(n_patches, N * N)`` does. Atoms code signals, not heights: see
`quadpatch.patches.normalisation` for the way from one to the other.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.errors import ModelError
from quadpatch.types import FloatArray

UNIT_NORM_TOLERANCE = 1e-6


@dataclass(frozen=True)
class Dictionary:
    """Atoms, and how many of them one patch may use.

    Attributes
    ----------
    atoms : (n_bins, n_atoms) float64
        Unit-norm columns.
    resolution : int
        Bins along one side of a patch; ``n_bins = resolution ** 2``.
    n_nonzero : int
        Atoms that one signal may use.

    Raises
    ------
    ModelError
        If the three do not fit each other, or an atom is not finite or not of unit norm.
    """

    atoms: FloatArray
    resolution: int
    n_nonzero: int

    def __post_init__(self) -> None:
        atoms = self.atoms
        if atoms.ndim != 2 or atoms.dtype != np.float64:
            raise ModelError(f"atoms must be a float64 matrix; got {atoms.dtype} of shape {atoms.shape}")
        if self.resolution < 1 or atoms.shape[0] != self.resolution**2:
            raise ModelError(f"atoms have {atoms.shape[0]} bins; a resolution of {self.resolution} needs its square")
        if not 1 <= self.n_nonzero <= min(atoms.shape):
            raise ModelError(f"{self.n_nonzero} atoms a signal; the limits are 1 and {min(atoms.shape)}")
        if not np.isfinite(atoms).all():
            raise ModelError("atoms hold infinite or NaN values")
        worst = float(np.abs(np.linalg.norm(atoms, axis=0) - 1.0).max())
        if worst > UNIT_NORM_TOLERANCE:
            raise ModelError(f"an atom's norm is {worst:.3g} away from 1; the limit is {UNIT_NORM_TOLERANCE:g}")

    @property
    def n_atoms(self) -> int:
        """Count of atoms."""
        return int(self.atoms.shape[1])

    @property
    def n_bins(self) -> int:
        """Count of bins of a patch."""
        return int(self.atoms.shape[0])
