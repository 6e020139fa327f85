"""How the bytes of an STL file are laid out: ascii or binary, and whether a binary file is what its count says.

A binary file has a header of 80 bytes, the count of facets in four, and 50 bytes for each facet. Three kinds of files
do not fit that:

- bytes behind the last facet, which some programs write: the file is read, and the bytes stay where they are;
- facets with data of their own behind them, as long as their attribute byte count says: read at 50 bytes a facet, such
  a file gives noise, so it is refused;
- a count that is not that of the facets, as of a program that was stopped: the file is refused.

Tested in `tests/quadpatch/formats/test_stl.py`.
"""

import re

import numpy as np

from quadpatch.errors import ReadError
from quadpatch.types import FloatArray

HEADER_SIZE = 84
FACET = np.dtype([("normal", "<f4", (3,)), ("vertices", "<f4", (3, 3)), ("attribute", "<u2")])

_SOLID = re.compile(rb"\s*solid", re.IGNORECASE)
_MARK = b"\xef\xbb\xbf"
# A stored normal is zero, or about as long as 1: programs round it, and some leave it out.
_LONGEST_NORMAL = 2.0
# Cosine between the stored normal and that of the corners.
_ALONG = 0.9
# Facets of one mesh differ in size by less than this factor from the middle one; bytes of text differ by far more.
_ALIKE = 1e4
# Records looked at to tell facets from other bytes.
_N_TRIED = 10

Facets = np.ndarray[tuple[int], np.dtype[np.void]]


def is_ascii_stl(data: bytes) -> bool:
    """Tell whether an STL file is text: it begins with `solid`, and has no byte 0 where a binary file has its count."""
    start = data[: HEADER_SIZE + FACET.itemsize].removeprefix(_MARK)
    return _SOLID.match(start) is not None and b"\0" not in start and not is_binary_stl(data)


def is_binary_stl(data: bytes) -> bool:
    """Tell whether the count in an STL header fits the size of the file exactly."""
    return len(data) >= HEADER_SIZE and len(data) == HEADER_SIZE + FACET.itemsize * _count(data)


def is_binary_stl_with_more(data: bytes) -> bool:
    """Tell whether a file is a binary STL with bytes behind its facets, as far as the first facets show."""
    if len(data) < HEADER_SIZE + FACET.itemsize:
        return False
    n_facets = _count(data)
    room = (len(data) - HEADER_SIZE) // FACET.itemsize
    return 0 < n_facets <= room and _look_like_facets(np.frombuffer(data, FACET, min(n_facets, _N_TRIED), HEADER_SIZE))


def check_layout(data: bytes) -> int:
    """Return the number of facets of a binary file.

    Parameters
    ----------
    data : bytes
        The whole file.

    Raises
    ------
    ReadError
        If size and count do not go together.
    """
    if len(data) < HEADER_SIZE:
        raise ReadError(f"an STL file has a header of {HEADER_SIZE} bytes; this file has {len(data)}")
    n_facets = _count(data)
    room = (len(data) - HEADER_SIZE) // FACET.itemsize
    if n_facets > room:
        raise ReadError(f"the STL header declares {n_facets:,} facets; the file has room for {room:,}")
    if len(data) > HEADER_SIZE + FACET.itemsize * n_facets:
        _check_more(data, n_facets)
    return n_facets


def _check_more(data: bytes, n_facets: int) -> None:
    """Refuse bytes behind the facets that are no trailer."""
    end = HEADER_SIZE + FACET.itemsize * n_facets
    facets = np.frombuffer(data, FACET, n_facets, HEADER_SIZE)
    sizes = f"{n_facets:,} facets take {end:,} bytes, and the file has {len(data):,}"
    if _end_with_payloads(data, n_facets) == len(data):
        raise ReadError(f"{sizes}: the facets carry data of their own (attribute byte counts), which is not read")
    if not _look_like_facets(facets):
        raise ReadError(f"{sizes}: what stands in the place of the facets is none")
    n_following = min((len(data) - end) // FACET.itemsize, _N_TRIED)
    if n_following and _goes_on(facets, np.frombuffer(data, FACET, n_following, end)):
        raise ReadError(f"the STL header declares {n_facets:,} facets, and more follow: {sizes}")


def _count(data: bytes) -> int:
    return int.from_bytes(data[HEADER_SIZE - 4 : HEADER_SIZE], "little")


def _end_with_payloads(data: bytes, n_facets: int) -> int:
    """Byte behind the last facet where each is followed by as many bytes as its attribute byte count says.

    -1 where that leads out of the file. The loop over facets ends as soon as it does.
    """
    end = HEADER_SIZE
    for _ in range(n_facets):
        behind = end + FACET.itemsize
        end = behind + int.from_bytes(data[behind - 2 : behind], "little")
        if end > len(data):
            return -1
    return end


def _look_like_facets(facets: Facets) -> bool:
    """Tell whether records may be facets, by their normals: noise has normals of any length and direction.

    Programs store normals of length 1, of length 0, or as long as the area; of facets without area they store anything.
    """
    corners = facets["vertices"].astype(np.float64)
    with np.errstate(over="ignore", invalid="ignore"):
        stored = facets["normal"].astype(np.float64)
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        lengths, areas = np.linalg.norm(stored, axis=1), np.linalg.norm(across, axis=1)
        is_along = np.einsum("ij,ij->i", stored, across) > _ALONG * lengths * areas
    return bool(((lengths <= _LONGEST_NORMAL) | is_along | (areas == 0)).all())


def _goes_on(facets: Facets, following: Facets) -> bool:
    """Tell whether the records behind the last facet are more of them: triangles with an area, of about their size."""
    corners = following["vertices"].astype(np.float64)
    if not (_look_like_facets(following) and np.isfinite(corners).all()):
        return False
    if not np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).any():
        return False
    sizes, known = _sizes(following), _sizes(facets)
    if not len(known):
        return True
    usual = float(np.median(known))
    return bool((sizes > usual / _ALIKE).all() and (sizes < usual * _ALIKE).all())


def _sizes(facets: Facets) -> FloatArray:
    """Largest extents (k,) along an axis of the facets that have any."""
    sizes = np.ptp(facets["vertices"].astype(np.float64), axis=1).max(axis=1, initial=0.0)
    return np.asarray(sizes[sizes > 0])
