"""Pictures of patches with a hole: masked, as each network completes them, and true."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from quadpatch.inpainters.onnx_network import AutoencoderInpainter
from quadpatch.types import BoolArray, FloatArray, Patches
from training.paper_task import spread_rows
from training.shards import Arrays
from training.smooth_fills import disk

_TILE = 1.5
_MASK = "tab:orange"


@dataclass(frozen=True)
class Tile:
    """One patch (N, N) as heights in patch lengths, with NaN where nothing is shown, and what is written under it."""

    heights: FloatArray
    caption: str = ""


def choose_patches(known: BoolArray, rows: Sequence[int], count: int) -> list[int]:
    """Choose some of the rows of patches (n, N, N), evenly, among those that are known in every bin."""
    whole = [row for row in rows if known[row].all()]
    return [whole[i] for i in spread_rows(len(whole), count).tolist()]


def completed_tiles(
    mesh: str, row: int, cut: Mapping[int, Arrays], networks: Mapping[str, Path], hole_share: float
) -> dict[str, Tile]:
    """Hide a disk in the middle of a patch and have networks complete it.

    Parameters
    ----------
    mesh : str
    row : int
        Of the patch.
    cut : mapping of int to arrays
        The same patches, `heights` in patch lengths and `known`, by resolution.
    networks : mapping of str to Path
        ONNX files by name.
    hole_share : float
        Diameter of the disk, in patch lengths.

    Returns
    -------
    dict of str to Tile
        `masked`, one for each network, and `truth`, in this order; masked and true in the finest resolution. Networks
        tell their root mean square error in the disk, in percent of the patch length.
    """
    finest = cut[max(cut)]["heights"][row].astype(np.float64)
    tiles = {"masked": Tile(np.where(disk(len(finest), hole_share), finest, np.nan), mesh)}
    for name, path in networks.items():
        network = AutoencoderInpainter.load(path)
        truth = cut[network.resolution]["heights"][row].astype(np.float64)
        known = disk(network.resolution, hole_share)
        completed = network.predict(_patch(np.where(known, truth, 0.0), known), np.zeros((1, *known.shape)))[0]
        error = np.sqrt(((completed - truth)[~known] ** 2).mean())
        tiles[name] = Tile(np.where(known, truth, completed), f"{100 * error:.2f} %")
    return {**tiles, "truth": Tile(finest)}


def patch_picture(rows: Sequence[Mapping[str, Tile]]) -> Figure:
    """Draw tiles of the same names below each other; grey goes from the lowest to the highest of the truth."""
    names = list(rows[0])
    figure = Figure(figsize=(_TILE * len(names), 1.15 * _TILE * len(rows)), layout="constrained")
    grid = figure.subplots(len(rows), len(names), squeeze=False)
    for row, tiles in enumerate(rows):
        truth = tiles["truth"].heights
        for column, name in enumerate(names):
            axes = grid[row, column]
            axes.set_facecolor(_MASK)
            axes.imshow(tiles[name].heights, cmap="gray", vmin=truth.min(), vmax=truth.max(), interpolation="nearest")
            axes.set_xticks([])
            axes.set_yticks([])
            axes.set_xlabel(tiles[name].caption, fontsize="small")
            if row == 0:
                axes.set_title(name, fontsize="small")
    return figure


def _patch(heights: FloatArray, known: BoolArray) -> Patches:
    """One patch of length 1."""
    mask = known[None]
    return Patches(np.zeros((1, 3)), np.eye(3)[None], 1.0, heights[None], mask, mask, np.zeros(mask.shape, np.int64))
