"""Hostile `.qpz` files: whatever the bytes, a coded error or a mesh, and no memory beyond the limits.

Tests `quadpatch.compression.header`, `quadpatch.compression.content`, `quadpatch.compression.vertex_streams` and
`quadpatch.compression.decode` as well.
"""

from dataclasses import asdict, replace

import numpy as np
import pytest

from quadpatch.compression import header as header_module
from quadpatch.compression.content import SELF, Lengths
from quadpatch.compression.decode import decode_mesh
from quadpatch.compression.header import Counts, read_header, write_header
from quadpatch.compression.qpz_file import decode_content, encode_content
from quadpatch.errors import FormatError, MeshError, ReadError, TooLargeError
from quadpatch.formats.limits import ReadLimits
from tests.quadpatch.compression.encoded import encoded

CASES = [("sphere", False, "cosine"), ("relief", False, SELF), ("sphere", True, "cosine")]
SMALL = ReadLimits(max_bytes=10**6, max_vertices=300_000, max_triangles=600_000)


def file_of(case: tuple[str, bool, str]) -> bytes:
    return encoded(*case).data


def resealed(data: bytes) -> bytes:
    """The same file with a digest that fits: damage that the digest does not show."""
    start = header_module._FIXED.size
    return data[: start - 16] + header_module._digest(data[start:]) + data[start:]


def outcome(data: bytes) -> str:
    """Code of the error, or that a mesh came out."""
    try:
        mesh = decode_mesh(data, None, SMALL).mesh  # type: ignore[arg-type]
    except MeshError as error:
        return error.code
    assert np.isfinite(mesh.vertices).all()
    assert mesh.triangles.max(initial=0) < len(mesh.vertices)
    return "mesh"


@pytest.mark.parametrize("case", CASES)
def test_a_file_that_is_read_and_written_again_has_the_same_bytes(case: tuple[str, bool, str]) -> None:
    content, parts = decode_content(file_of(case), ReadLimits())
    assert encode_content(content, parts) == file_of(case)


@pytest.mark.parametrize("case", CASES)
def test_every_mutated_byte_is_noticed(case: tuple[str, bool, str]) -> None:
    data = file_of(case)
    rng = np.random.default_rng(0)
    places = np.unique(np.concatenate([np.arange(120), rng.integers(len(data), size=200)]))
    for place in places[places < len(data)].tolist():
        mutated = bytearray(data)
        mutated[place] ^= int(rng.integers(1, 256))
        with pytest.raises((ReadError, FormatError)):
            decode_content(bytes(mutated), SMALL)


@pytest.mark.parametrize("case", CASES)
def test_a_truncated_file_is_noticed_wherever_it_ends(case: tuple[str, bool, str]) -> None:
    data = file_of(case)
    for end in np.unique(np.linspace(0, len(data) - 1, 60).astype(int)).tolist():
        with pytest.raises(ReadError):
            decode_content(data[:end], SMALL)
    with pytest.raises(ReadError):
        decode_content(data + b"\0", SMALL)


@pytest.mark.parametrize("case", CASES)
def test_mutations_behind_a_digest_that_fits_end_in_a_coded_error_or_a_mesh(case: tuple[str, bool, str]) -> None:
    data = file_of(case)
    rng = np.random.default_rng(1)
    start = header_module._FIXED.size
    codes = set()
    for place in [*range(start, min(start + 110, len(data))), *rng.integers(start, len(data), 60).tolist()]:
        mutated = bytearray(data)
        mutated[place] ^= 1 << int(rng.integers(8))
        codes.add(outcome(resealed(bytes(mutated))))
    assert "unreadable_mesh" in codes


@pytest.mark.parametrize("case", CASES)
def test_truncations_behind_a_digest_that_fits_end_in_a_coded_error(case: tuple[str, bool, str]) -> None:
    data = file_of(case)
    for end in np.unique(np.linspace(header_module._FIXED.size, len(data) - 1, 40).astype(int)).tolist():
        assert outcome(resealed(data[:end])) != "mesh"


def changed(data: bytes, **counts: int) -> bytes:
    header, body = read_header(data)
    return write_header(replace(header, counts=replace(header.counts, **counts)), body)


@pytest.mark.parametrize("name", [entry for entry in Counts.__annotations__ if entry != "levels"])
@pytest.mark.parametrize("count", [10**5, 10**9, 2**60])
def test_a_count_that_is_too_large_is_refused(name: str, count: int) -> None:
    with pytest.raises(MeshError):
        decode_mesh(changed(file_of(CASES[0]), **{name: count}), None, SMALL)  # type: ignore[arg-type]


def test_more_cells_than_the_limit_are_refused_before_they_are_made() -> None:
    with pytest.raises(TooLargeError, match="the limit is"):
        decode_content(changed(file_of(CASES[0]), levels=6, quads=10**6), SMALL)


def test_another_version_is_refused() -> None:
    data = bytearray(file_of(CASES[0]))
    data[4] = 2
    with pytest.raises(FormatError, match="version 2"):
        decode_content(bytes(data), SMALL)


@pytest.mark.parametrize("value", [np.nan, np.inf, 0.0, -1.0, 1e300])
@pytest.mark.parametrize("name", ["max_error", "place_step", "code_step"])
def test_a_step_that_is_no_length_is_refused(name: str, value: float) -> None:
    header, body = read_header(file_of(CASES[0]))
    lengths = Lengths(**{**asdict(header.lengths), name: value})
    damaged = replace(header, lengths=lengths)
    with pytest.raises(ReadError, match="no length"):
        decode_content(write_header(damaged, body), SMALL)


def test_packed_triangles_that_unpack_to_more_than_claimed_are_refused() -> None:
    header, _ = read_header(file_of(CASES[2]))
    with pytest.raises(MeshError):
        decode_content(changed(file_of(CASES[2]), kept_triangles=header.counts.kept_triangles - 1), SMALL)
