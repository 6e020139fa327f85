"""The reports of the tasks other than `fill`. Lengths are in the unit that `length_unit` of a report names.

Tested in `tests/quadpatch_client/schema/test_reports.py`.
"""

from typing import Literal

from pydantic import Field

from quadpatch_client.schema.base import Response
from quadpatch_client.schema.report_parts import AppliedPatches, Patches, SourceMesh, TaskReport, Welded


class RestoredVertices(Response):
    """Counts of missing vertices."""

    missing: int = Field(ge=0, description="Vertices without a position.", examples=[1210])
    restored: int = Field(ge=0, description="Those that got one.", examples=[1200])
    left: int = Field(ge=0, description="Those that are connected to no measured vertex.", examples=[10])


class HiddenVertices(Response):
    """Measured vertices that were hidden, restored and compared."""

    count: int = Field(ge=0, description="How many.", examples=[400])
    rms_error: dict[str, float | None] = Field(
        description="Root mean square error of each way to place them, in mesh units.", examples=[{"energies": 0.002}]
    )


class ErrorSpread(Response):
    """How an expected error is spread over the vertices, in mesh units."""

    rms: float | None = Field(description="Root mean square.", examples=[0.002])
    median: float | None = Field(description="Half of the vertices are expected to be closer.", examples=[0.001])
    percentile_95: float | None = Field(description="95 of 100 are.", examples=[0.004])


class RestoreReport(TaskReport):
    """The report of `restore`."""

    task: Literal["restore"] = Field(description="What was done.", examples=["restore"])
    source: SourceMesh = Field(description="The mesh that came in, with the restored vertices in their place.")
    vertices: RestoredVertices = Field(description="Counts of missing vertices.")
    placement: str = Field(description="How they were placed: the way with the least error.", examples=["energies"])
    hidden_vertices: HiddenVertices = Field(description="What the choice was made by.")
    patches: AppliedPatches | None = Field(description="The patches of the model; null without one.")
    expected_error: ErrorSpread = Field(description="Of the restored vertices.")


class Folds(Response):
    """Places where the moved surface would fold over."""

    before: int = Field(ge=0, description="Before the check.", examples=[3])
    undone: int = Field(ge=0, description="Taken back by the check.", examples=[3])
    left: list[int] = Field(description="Triangles that are still folded.", examples=[[]])


class DenoiseReport(TaskReport):
    """The report of `denoise`."""

    task: Literal["denoise"] = Field(description="What was done.", examples=["denoise"])
    source: SourceMesh = Field(description="The mesh that came in.")
    welded: Welded = Field(description="How its triangles became one surface.")
    noise: float = Field(ge=0, description="Standard deviation of the noise, in mesh units.", examples=[0.01])
    noise_estimated: bool = Field(description="Whether it was estimated, not given.", examples=[True])
    max_shift: float = Field(ge=0, description="Largest shift that was allowed, in mesh units.", examples=[0.04])
    moved_vertices: int = Field(ge=0, description="Vertices that were moved.", examples=[85_000])
    shift_mean: float = Field(ge=0, description="Mean shift of these, in mesh units.", examples=[0.008])
    shift_95: float = Field(ge=0, description="95 of 100 of these moved no farther, in mesh units.", examples=[0.02])
    shift_max: float = Field(ge=0, description="Largest shift, in mesh units.", examples=[0.035])
    vertices_at_bound: int = Field(ge=0, description="Vertices that `max_shift` held back.", examples=[0])
    turned_triangles: int = Field(ge=0, description="Triangles whose normals turned by over 90 degrees.", examples=[0])
    folds: Folds = Field(description="What the check of the result found.")
    shares: dict[str, float] = Field(
        description="The filters that were mixed, each with its share.", examples=[{"diffusion_2": 0.6, "none": 0.4}]
    )
    patches: Patches | None = Field(description="The patches of the model; null without one.")


class BothWays(Response):
    """A distance between two surfaces, seen from each of them."""

    true_to_decoded: float | None = Field(description="From points of the scan.", examples=[0.0092])
    decoded_to_true: float | None = Field(description="From points of the decoded surface.", examples=[0.0079])


class LargestError(BothWays):
    """The largest distance between scan and decoded surface, in mesh units."""

    promised: float = Field(description="What was asked for, and is kept.", examples=[0.01])


class DecodedMesh(Response):
    """Counts of the decoded mesh."""

    vertices: int = Field(ge=0, description="Vertices.", examples=[2500])
    triangles: int = Field(ge=0, description="Triangles.", examples=[4809])


class VertexShift(Response):
    """How far vertices moved, in mesh units."""

    max: float = Field(ge=0, description="Farthest.", examples=[0.0099])
    rms: float = Field(ge=0, description="Root mean square.", examples=[0.002])


class UsedDictionary(Response):
    """The dictionary that patches are coded over."""

    kind: str = Field(description="`self`, `cosine` or `model`.", examples=["cosine"])
    atoms: int = Field(ge=0, description="How many atoms it has.", examples=[6])


class GridPatches(Response):
    """The patches of an encoded surface."""

    count: int = Field(ge=0, description="How many.", examples=[158])
    resolution: int = Field(ge=1, description="Cells along a side.", examples=[4])


class CodedPatches(GridPatches):
    """The same, with what was stored for them."""

    corrected: int = Field(ge=0, description="Patches with a corrected vertex.", examples=[16])
    nonzero_coefficients: int = Field(ge=0, description="Coefficients that were stored.", examples=[105])


class Entities(Response):
    """Numbers that were counted."""

    mesh: int = Field(ge=0, description="Of the mesh.", examples=[7515])
    file: int = Field(ge=0, description="Of the file.", examples=[1175])


class EncodeReport(TaskReport):
    """The report of `encode`."""

    task: Literal["encode"] = Field(description="What was done.", examples=["encode"])
    source: SourceMesh = Field(description="The mesh that came in.")
    bytes: int = Field(ge=0, description="Size of the file, in bytes.", examples=[905])
    max_error: LargestError = Field(description="Largest distance of the surfaces, in mesh units.")
    rms_error: BothWays = Field(description="Root mean square distance of the surfaces, in mesh units.")
    psnr: BothWays = Field(description="Peak signal-to-noise ratio, in dB, of the diagonal.")
    sample_spacing: float = Field(description="Distance of the points that were compared, in mesh units.")
    vertex_shift: VertexShift | None = Field(
        default=None, description="How far vertices moved, where connectivity is kept; else not there."
    )
    dictionary: UsedDictionary = Field(description="What patches are coded over.")
    decoded: DecodedMesh = Field(description="Counts of the decoded mesh.")
    patches: CodedPatches = Field(description="The patches of the encoded surface.")
    corrections: int = Field(ge=0, description="Grid vertices with a correction.", examples=[21])
    cells_left_out: int = Field(ge=0, description="Grid cells without surface.", examples=[140])
    triangles_as_they_are: int = Field(ge=0, description="Triangles stored without patches.", examples=[33])
    entities: Entities = Field(description="Coordinates of the mesh, and numbers in their place.")
    entity_factor: float = Field(description="Their ratio, as the paper counts.", examples=[6.4])
    entity_factor_with_indices: float = Field(description="The same with indices counted.", examples=[10.6])
    draco_estimate: float | None = Field(
        description="Bytes that edge collapse and Draco would take at the same RMS error, estimated.", examples=[2378.0]
    )
    bytes_per_vertex: float = Field(ge=0, description="Bytes for each vertex of the scan.", examples=[0.36])
    ratio: float = Field(
        ge=0, description="How many times smaller than float32 positions and int32 triangles.", examples=[98.6]
    )


class EncodedSource(Response):
    """The `.qpz` file that came in."""

    format: Literal["qpz"] = Field(description="Format of the file.", examples=["qpz"])
    bytes: int = Field(ge=0, description="Size, in bytes.", examples=[905])


class DecodeReport(TaskReport):
    """The report of `decode`."""

    task: Literal["decode"] = Field(description="What was done.", examples=["decode"])
    source: EncodedSource = Field(description="The file that came in.")
    max_error: float = Field(
        ge=0, description="How far the surface lies from the scan at most, in mesh units, as the file promises."
    )
    decoded: DecodedMesh = Field(description="Counts of the decoded mesh.")
    keeps_connectivity: bool = Field(description="Whether vertices and triangles are those of the scan.")
    patches: GridPatches = Field(description="The patches of the encoded surface.")
