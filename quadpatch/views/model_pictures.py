"""Pictures of models: the atoms of a dictionary, or the filters of a network's first convolution, in a grid.

Each tile has its own scale: grey is 0, white the largest absolute value of the tile, black the same below 0.
"""

from pathlib import Path

import numpy as np
from PIL import Image

from quadpatch.inpainters.model_file import load_model
from quadpatch.inpainters.onnx_filters import first_filters
from quadpatch.preview.png import write_png
from quadpatch.types import FloatArray

# In pixels: of the picture, of the gaps between tiles, and of the smallest tile. More tiles are not drawn.
_WIDTH, _GAP, _LEAST_TILE = 1200, 3, 24
MOST_TILES = 1024
_TINY = 1e-300


def draw_model(path: Path, output: Path) -> None:
    """Draw a model file as PNG.

    Raises
    ------
    ModelError
        If the file is no model, or holds nothing that can be drawn.
    """
    write_png(output, model_picture(path))


def model_picture(path: Path) -> Image.Image:
    """Draw the tiles of a model, row by row in the order of the file, on white."""
    tiles = _tiles(path)[:MOST_TILES]
    n = len(tiles)
    n_columns = int(np.ceil(np.sqrt(n)))
    side = max(_LEAST_TILE, (_WIDTH - _GAP) // n_columns - _GAP)
    n_rows = -(-n // n_columns)
    picture = Image.new("L", (n_columns * (side + _GAP) + _GAP, n_rows * (side + _GAP) + _GAP), 255)
    for i, tile in enumerate(tiles):
        shades = np.rint(127.5 + 127.5 * tile / max(np.abs(tile).max(), _TINY)).astype(np.uint8)
        drawn = Image.fromarray(shades).resize((side, side), Image.Resampling.NEAREST)
        picture.paste(drawn, (_GAP + i % n_columns * (side + _GAP), _GAP + i // n_columns * (side + _GAP)))
    return picture


def _tiles(path: Path) -> FloatArray:
    """Height maps (n, rows, columns) of a model; of each filter the first channel, that of the heights."""
    model = load_model(path)
    if model.dictionary is None:
        return first_filters(path.read_bytes(), path.name)[:, 0]
    resolution = model.dictionary.resolution
    return np.asarray(model.dictionary.atoms.T.reshape(-1, resolution, resolution))
