"""The error curve of a training run: in the terminal, as JSON, as a picture."""

import json
from pathlib import Path

from PIL import Image, ImageDraw

from quadpatch.errors import OptionError
from quadpatch.types import FloatArray

BARS = "▁▂▃▄▅▆▇█"
SIZE = (640, 360)
MARGIN = 40


def text_curve(errors: FloatArray) -> str:
    """Draw the errors (n,) as one line of bars between the first and the last of them, with their values."""
    if len(errors) == 0:
        return ""
    low, high = float(errors.min()), float(errors.max())
    heights = (errors - low) / (high - low) if high > low else errors * 0.0
    bars = "".join(BARS[round(height * (len(BARS) - 1))] for height in heights.tolist())
    return f"{errors[0]:.4f} {bars} {errors[-1]:.4f}"


def write_curve(path: Path, errors: FloatArray, name: str = "rms_error") -> None:
    """Write the errors (n,) as `.json` (a list) or `.png` (a line over the iterations).

    Parameters
    ----------
    path : Path
    errors : (n,) float64
    name : str
        What they are, for the reader of the file.

    Raises
    ------
    OptionError
        If the suffix is another one.
    """
    if path.suffix == ".json":
        path.write_text(json.dumps({name: errors.tolist()}) + "\n", "utf-8")
    elif path.suffix == ".png":
        _draw(errors, name).save(path)
    else:
        raise OptionError(f"a curve is written as .json or .png; got {path.name}")


def _draw(errors: FloatArray, name: str) -> Image.Image:
    """Draw a line over the iterations; the axis of errors starts at 0."""
    image = Image.new("RGB", SIZE, "white")
    draw = ImageDraw.Draw(image)
    left, right, top, bottom = MARGIN, SIZE[0] - MARGIN, MARGIN, SIZE[1] - MARGIN
    draw.line([(left, top), (left, bottom), (right, bottom)], fill="black")
    highest = float(errors.max(initial=0.0)) or 1.0
    steps = max(len(errors) - 1, 1)
    points = [
        (left + (right - left) * i / steps, bottom - (bottom - top) * error / highest)
        for i, error in enumerate(errors.tolist())
    ]
    if len(points) > 1:
        draw.line(points, fill=(200, 60, 20), width=3)
    draw.text((left, bottom + 8), f"1 to {len(errors)}", fill="black")
    draw.text((left, top - 20), f"{name.replace('_', ' ')}, {highest:.3g} at the top", fill="black")
    return image
