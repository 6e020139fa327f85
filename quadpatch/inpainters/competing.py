"""Several models for one mesh, of which calibration takes the best one, or the mean of some: the model `auto`.

A mean of predictions has the smaller error where models err in different ways (T. Hastie, R. Tibshirani, J. Friedman,
"The Elements of Statistical Learning", 2009, section 8.8).
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from itertools import chain, combinations

import numpy as np

from quadpatch.inpainters.inpainter import FittedInpainter, Inpainter, UndamagedSurface
from quadpatch.types import FloatArray, Patches


@dataclass(frozen=True)
class FittedCompetitors:
    """Fitted models by name, and the share that each has in what they predict; shares sum to 1."""

    members: Mapping[str, FittedInpainter]
    shares: Mapping[str, float]

    @property
    def resolution(self) -> int:
        """Bins along one side of their patches."""
        return next(iter(self.members.values())).resolution

    def mixtures(self) -> list["FittedCompetitors"]:
        """List what may be taken: each model by itself, and the mean of any several."""
        groups = chain.from_iterable(combinations(self.members, n + 1) for n in range(len(self.members)))
        return [FittedCompetitors(self.members, dict.fromkeys(names, 1.0 / len(names))) for names in groups]

    def mixed(self, predicted: Mapping[str, FloatArray]) -> FloatArray:
        """Mix what the models predict, (n_patches, N, N) each, by their shares."""
        return np.asarray(np.sum([share * predicted[name] for name, share in self.shares.items()], axis=0))

    def predict_each(self, patches: Patches, base_heights: FloatArray) -> dict[str, FloatArray]:
        """Ask every model that has a share, see `FittedInpainter.predict`."""
        return {name: self.members[name].predict(patches, base_heights) for name in self.shares}

    def predict(self, patches: Patches, base_heights: FloatArray) -> FloatArray:
        """See `FittedInpainter`."""
        return self.mixed(self.predict_each(patches, base_heights))


@dataclass(frozen=True)
class CompetingInpainters:
    """Models by name, for patches of one resolution."""

    members: Mapping[str, Inpainter]

    @property
    def resolution(self) -> int | None:
        """See `Inpainter`: that of the first model that has one."""
        known = (member.resolution for member in self.members.values())
        return next((resolution for resolution in known if resolution is not None), None)

    def limited_to(self, names: Collection[str]) -> "CompetingInpainters":
        """Leave out all models but some."""
        return CompetingInpainters({name: member for name, member in self.members.items() if name in names})

    def fitted_to(self, undamaged: UndamagedSurface) -> FittedCompetitors | None:
        """See `Inpainter`; models for which the mesh shows too little are left out."""
        fitted = {name: member.fitted_to(undamaged) for name, member in self.members.items()}
        able = {name: member for name, member in fitted.items() if member is not None}
        return FittedCompetitors(able, {name: 1.0 / len(able) for name in able}) if able else None
