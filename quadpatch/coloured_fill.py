"""Colours of new vertices, in the file's own vertices: what a repair that knows files asks of `quadpatch.colours`."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.colours.calibration import Verdict
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.formats.scan import Scan
from quadpatch.mesh.measures import edge_statistics
from quadpatch.mesh.weld import Weld
from quadpatch.options import RepairOptions
from quadpatch.stages import Stages, failure_of
from quadpatch.types import FloatArray
from quadpatch_rules.coded_warnings import warning

# The format that has no place for colours of vertices.
_COLOURLESS = ".stl"


@dataclass(frozen=True)
class ColouredFill:
    """Colours of the new vertices of a repair.

    Attributes
    ----------
    method : str or None
        `exemplars` or `harmonic`; None for a scan without colours, or a format that has no place for them.
    colours : (n_new, 3) float64 or None
        See `quadpatch.formats.scan.Fill`.
    verdict : Verdict or None
    warnings : list of str
    """

    method: str | None = None
    colours: FloatArray | None = None
    verdict: Verdict | None = None
    warnings: tuple[str, ...] = ()

    def described(self) -> dict[str, Any] | None:
        """Return what a report says, JSON-ready; None where there are no colours."""
        if self.method is None:
            return None
        return {"method": self.method, "calibration": None if self.verdict is None else asdict(self.verdict)}


def colour_fill(
    scan: Scan, welded: Weld, filled: FilledMesh, output: Path, options: RepairOptions, stages: Stages
) -> ColouredFill:
    """Colour the new vertices of a repair where the vertices of its scan have colours.

    A failure is a warning: the colours of the rim are then spread over the fill, as every format's writer does.

    Parameters
    ----------
    scan : Scan
    welded : Weld
        Of the scan.
    filled : FilledMesh
        Its measured vertices are those of `welded`.
    output : Path
        Its suffix says the format.
    options : RepairOptions
    stages : Stages
    """
    suffix = output.suffix.lower()
    # New triangles of a 3MF package get the material of their neighbour, whatever their vertices have.
    has_place = suffix != _COLOURLESS and not suffix == f".{scan.format}" == ".3mf"
    if scan.source is None or not has_place or not len(filled.vertex_hole):
        return ColouredFill()
    found: list[ColouredFill] = []
    source = scan.source

    def look() -> None:
        colours = source.vertex_colours(scan)
        if colours is None or options.colours == "harmonic":
            found.append(ColouredFill(None if colours is None else "harmonic"))
            return
        with stages.stage("colour"):
            found.append(_continued(welded, filled, colours[welded.to_file, :3], options.seed))

    failure = failure_of(look)
    if failure is None:
        return found[0]
    return ColouredFill("harmonic", warnings=(warning("colours_not_continued", reason=failure),))


def _continued(welded: Weld, filled: FilledMesh, colours: FloatArray, seed: int) -> ColouredFill:
    from quadpatch.colours.continuation import continue_colours  # noqa: PLC0415  most scans do without

    new = continue_colours(filled, colours, edge_statistics(welded.mesh), np.random.default_rng([seed, 3]))
    return ColouredFill(new.method, new.colours, new.verdict)
