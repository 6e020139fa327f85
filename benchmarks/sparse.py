"""Time of sparse coding: ``python -m benchmarks.sparse``.

Masked OMP on patches of 24 x 24 bins, 500 atoms, 20 non-zeros: batched, one signal after the other, and the floor (the
matrix products alone, one for each step). Then K-SVD with 256 atoms on 2,000 patches.
"""

import time
from collections.abc import Callable

import numpy as np
from rich.console import Console
from rich.table import Table

from quadpatch.sparse.ksvd import KsvdOptions, masked_ksvd
from quadpatch.sparse.omp import masked_omp
from quadpatch.sparse.parallel import map_batches, n_processors
from quadpatch.types import BoolArray, FloatArray

N_BINS, N_ATOMS, N_NONZERO, N_SIGNALS, N_ALONE = 576, 500, 20, 2000, 50


def main() -> None:
    """Measure and print."""
    rng = np.random.default_rng(0)
    atoms = rng.normal(size=(N_BINS, N_ATOMS))
    atoms /= np.linalg.norm(atoms, axis=0)
    signals = rng.normal(size=(N_SIGNALS, N_BINS))
    known = rng.random(signals.shape) > 0.3
    everywhere = np.ones_like(known)
    table = Table("what", "ms a patch", title=f"{n_processors()} processors")
    rows: list[tuple[str, Callable[[], object], int]] = [
        ("masked, every mask its own", lambda: masked_omp(signals, known, atoms, N_NONZERO), N_SIGNALS),
        ("one mask for all", lambda: masked_omp(signals, everywhere, atoms, N_NONZERO), N_SIGNALS),
        ("floor: the matrix products", lambda: _products(signals, atoms), N_SIGNALS),
        ("one by one, least squares anew", lambda: _one_by_one(signals, known, atoms), N_ALONE),
    ]
    for name, work, count in rows:
        table.add_row(name, f"{1000 * _best_of_three(work) / count:.3f}")
    console = Console()
    console.print(table)
    options, all_known = KsvdOptions(256, 10, 10), np.ones(signals.shape, dtype=np.bool_)
    seconds = _best_of_three(lambda: masked_ksvd(signals, all_known, options, np.random.default_rng(1)))
    console.print(f"K-SVD, 256 atoms, 10 non-zeros, 10 iterations, {N_SIGNALS} patches: {seconds:.1f} s")


def _best_of_three(work: Callable[[], object]) -> float:
    times = []
    for _ in range(3):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def _products(signals: FloatArray, atoms: FloatArray) -> None:
    def product(start: int) -> None:
        for _ in range(N_NONZERO):
            signals[start : start + 128] @ atoms

    map_batches(product, range(0, len(signals), 128))


def _one_by_one(signals: FloatArray, known: BoolArray, atoms: FloatArray) -> None:
    for signal, mask in zip(signals[:N_ALONE], known[:N_ALONE], strict=True):
        visible, target = atoms[mask], signal[mask]
        norms = np.linalg.norm(visible, axis=0)
        support: list[int] = []
        residual = target
        for _ in range(N_NONZERO):
            scores = np.abs(residual @ visible) / norms
            scores[support] = 0.0
            support.append(int(scores.argmax()))
            residual = target - visible[:, support] @ np.linalg.lstsq(visible[:, support], target, rcond=None)[0]


if __name__ == "__main__":
    main()
