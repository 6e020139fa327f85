"""A texture page for new triangles, in those of the file: how a repair that knows files asks `quadpatch.textures`."""

import re
from dataclasses import asdict, dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.errors import TextureError
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.formats.scan import Fill, Scan
from quadpatch.formats.surface_texture import ImageProblem, SurfaceTexture, TexturePage
from quadpatch.formats.writing import takes_page, written_as
from quadpatch.mesh.weld import Weld
from quadpatch.options import RepairOptions
from quadpatch.stages import Stages, failure_of
from quadpatch.types import BoolArray
from quadpatch_rules.coded_warnings import warning


@dataclass(frozen=True)
class TexturedFill:
    """Texture of the fills of a repair.

    Attributes
    ----------
    page : TexturePage or None
    report : dict or None
        What a report says, JSON-ready; None where there is no texture, or nothing new.
    warnings : tuple of str
    """

    page: TexturePage | None = None
    report: dict[str, Any] | None = None
    warnings: tuple[str, ...] = ()


def texture_fill(  # noqa: PLR0913, PLR0917  a repair, and how it is to be written
    scan: Scan, welded: Weld, filled: FilledMesh, fill: Fill, output: Path, options: RepairOptions, stages: Stages
) -> TexturedFill:
    """Paint a texture page for the new triangles of a repair where its scan has texture images.

    Where an image can't be read, or painting fails, a warning says so, and new triangles have texture coordinates
    spread from the rim.

    Parameters
    ----------
    scan : Scan
    welded : Weld
        Of the scan.
    filled : FilledMesh
        Its measured vertices are those of `welded`.
    fill : Fill
        The same in the file's vertices.
    output : Path
    options : RepairOptions
    stages : Stages
    """
    named = written_as(output, scan)
    found: list[TexturedFill] = []

    def look() -> None:
        if scan.source is None or not len(fill.triangles):
            return
        try:
            texture = scan.source.surface_texture(scan)
        except TextureError as error:
            found.append(_without_page([ImageProblem("of the scan", error.code, str(error))]))
            return
        if texture is None:
            return
        if not takes_page(scan, output):
            found.append(TexturedFill(warnings=(warning("textures_not_written", suffix=named.suffix),)))
            return
        with stages.stage("colour"):
            found.append(_painted(scan, welded, filled, fill, texture, named, options))

    failure = failure_of(look)
    if failure is not None:
        return TexturedFill(warnings=(warning("textures_not_continued", reason=failure),))
    return found[0] if found else TexturedFill()


def _painted(  # noqa: PLR0913, PLR0917  see above
    scan: Scan,
    welded: Weld,
    filled: FilledMesh,
    fill: Fill,
    texture: SurfaceTexture,
    output: Path,
    options: RepairOptions,
) -> TexturedFill:
    from quadpatch.textures.painting import paint_fills  # noqa: PLC0415  most scans do without it

    rng = np.random.default_rng([options.seed, 4])
    painted = paint_fills(filled, _on_welded(scan, welded, texture), rng, is_harmonic=options.colours == "harmonic")
    bare = _without_page(painted.problems)
    if painted.page is None:
        return bare
    page, layout = painted.page, painted.page.layout
    report = {
        "method": painted.method,
        "calibration": None if painted.verdict is None else asdict(painted.verdict),
        "page": {"width": layout.width, "height": layout.height, "charts": layout.n_charts},
        "problems": [asdict(problem) for problem in painted.problems],
    }
    coordinates = np.full((len(fill.triangles), 3, 2), np.nan)
    coordinates[page.rows] = layout.coordinates
    turned = _turned(scan, welded, filled, fill)
    coordinates[turned] = coordinates[turned][:, ::-1]
    material = np.full(len(fill.triangles), -1)
    material[page.rows] = page.material
    # Names in material libraries hold no spaces, and some readers know ASCII alone.
    plain = re.sub(r"[^A-Za-z0-9._-]", "_", output.stem)
    stem = f"{plain}_fill_{sha256(page.png).hexdigest()[:8]}"
    return TexturedFill(TexturePage(page.png, coordinates, material, stem), report, bare.warnings)


def _without_page(problems: list[ImageProblem]) -> TexturedFill:
    """Say what is wrong with images, in the report and to people."""
    warnings = tuple(
        warning("texture_image_not_continued", image=problem.image, image_code=problem.code, reason=problem.message)
        for problem in problems
    )
    report = {"method": None, "calibration": None, "page": None, "problems": [asdict(problem) for problem in problems]}
    return TexturedFill(None, report, warnings)


def _turned(scan: Scan, welded: Weld, filled: FilledMesh, fill: Fill) -> BoolArray:
    """Which new triangles (l,) the file has in the other direction."""
    n_new = len(filled.vertex_hole)
    to_file = np.concatenate([welded.to_file, len(scan.vertices) + np.arange(n_new)])
    first = to_file[filled.new_triangles[:, 0]]
    return np.asarray(first != fill.triangles[:, 0])


def _on_welded(scan: Scan, welded: Weld, texture: SurfaceTexture) -> SurfaceTexture:
    """Take the texture of a file's triangles to those of its welded mesh; of repeated ones the first counts."""
    named = welded.from_file[scan.triangles]
    n = len(welded.mesh.vertices)
    triples = np.sort(np.concatenate([named, welded.mesh.triangles]), axis=1)
    # Of millions of vertices the product of three numbers does not fit into an integer, that of two does.
    pair = np.unique(triples[:, 0] * np.int64(n) + triples[:, 1], return_inverse=True)[1]
    keys = pair.reshape(-1) * np.int64(n) + triples[:, 2]
    order = np.argsort(keys[: len(named)], kind="stable")
    row = order[np.searchsorted(keys[order], keys[len(named) :])]
    corner = (named[row][:, np.newaxis] == welded.mesh.triangles[:, :, np.newaxis]).argmax(axis=2)
    coordinates = np.take_along_axis(texture.coordinates[row], corner[:, :, np.newaxis], axis=1)
    return SurfaceTexture(coordinates, texture.material[row], texture.images)
