"""3MF: reading what a package builds as one mesh.

Every build item is followed through its components, across model parts, and placed by its transforms. The unit is the
one that the root model states. Beam lattices, slices and volumes are no surface and are left out.
"""

import re
from dataclasses import dataclass, field

import numpy as np

from quadpatch.errors import EmptyMeshError, ReadError, TooLargeError
from quadpatch.formats.limits import ReadLimits, check_triangles, check_vertices
from quadpatch.formats.marks import next_hole_id
from quadpatch.formats.scan import Scan
from quadpatch.formats.scene_parts import Part, place
from quadpatch.formats.threemf.model import Model, ModelObject, Placed, parse_model
from quadpatch.formats.threemf.package import Package, open_package
from quadpatch.formats.threemf.source import Origin, ThreemfSource
from quadpatch.types import FloatArray

# As our writers put them down.
_HOLE_MARK = re.compile(rb' q:hole="([0-9]{1,9})"')

# Components may be nested so that a file of a kilobyte places an object 2**50 times.
_MOST_INSTANCES = 100_000
_DEEPEST = 64


@dataclass
class _Build:
    """Meshes placed so far."""

    package: Package
    limits: ReadLimits
    models: dict[str, Model] = field(default_factory=dict)
    placed: list[tuple[Origin, ModelObject, FloatArray]] = field(default_factory=list)
    n_instances: int = 0
    n_vertices: int = 0
    n_triangles: int = 0

    def model(self, path: str) -> Model:
        """Model part at a path, parsed once."""
        if path not in self.models:
            self.models[path] = parse_model(self.package.read(path), self.limits)
        return self.models[path]

    def add(self, path: str, reference: Placed, parent: FloatArray, depth: int) -> None:
        """Place an object with all its components."""
        self.n_instances += 1
        if self.n_instances > _MOST_INSTANCES:
            raise TooLargeError(f"the 3MF package places more than {_MOST_INSTANCES:,} objects")
        if depth > _DEEPEST:
            raise ReadError(f"3MF components are nested deeper than {_DEEPEST}, or contain themselves")
        path = path if reference.path is None else reference.path.lstrip("/")
        entry = self.model(path).objects.get(reference.object_id)
        if entry is None:
            raise ReadError(
                f"the 3MF package names object {reference.object_id[:40]!r} of {path[:80]!r}, which is not there"
            )
        with np.errstate(over="ignore", invalid="ignore"):  # what overflows is refused as not finite
            matrix = parent @ reference.matrix
        if len(entry.triangles):
            self.placed.append((Origin(path, reference.object_id), entry, matrix))
            self.n_vertices += len(entry.vertices)
            self.n_triangles += len(entry.triangles)
            self.limits.check_vertices(self.n_vertices)
            self.limits.check_triangles(self.n_triangles)
        for component in entry.components:
            self.add(path, component, matrix, depth + 1)


def read_threemf(data: bytes, limits: ReadLimits) -> Scan:
    """Read a 3MF package.

    Parameters
    ----------
    data : bytes
        The whole file.
    limits : ReadLimits

    Raises
    ------
    MeshError
        ReadError, FormatError, EmptyMeshError, NotFiniteError, IndexRangeError or TooLargeError.
    """
    package = open_package(data, limits)
    build = _Build(package, limits)
    root = build.model(package.root)
    for item in root.items:
        build.add(package.root, item, np.eye(4), 0)
    if not build.placed:
        raise EmptyMeshError(f"the {len(root.items)} items that the 3MF package builds have no triangle")
    parts: list[Part] = []
    vertices, triangles = [], []
    first = 0
    for _, entry, matrix in build.placed:
        part = Part(first, entry.vertices, matrix)
        parts.append(part)
        vertices.append(place(entry.vertices, matrix))
        triangles.append((entry.triangles[:, [0, 2, 1]] if part.is_mirrored else entry.triangles) + first)
        first += len(entry.vertices)
    all_vertices, all_triangles = np.concatenate(vertices), np.concatenate(triangles)
    check_vertices(all_vertices, limits.allow_missing)
    check_triangles(all_triangles, limits)
    origins = [origin for origin, _, _ in build.placed]
    source = ThreemfSource(package, build.models, parts, origins)
    marks = [np.array([float(n) for n in _HOLE_MARK.findall(model.text)]) for model in build.models.values()]
    return Scan(all_vertices, all_triangles, "3mf", root.unit, source, next_hole_id(marks))
