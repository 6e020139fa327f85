"""How many bytes edge collapse and Draco would take for the same error, without Draco.

The mesh is collapsed to half as many triangles again and again until it is farther from the surface than the encoded
one; in between, sizes are interpolated. The bytes that Draco takes for a vertex were measured with 11 bits on the
meshes of `benchmarks/compression.py`: 3.33 at 1,391 vertices, 2.88 at 3,336, 2.65 at 8,194 and 2.36 at 16,386.

References
----------
J. Rossignac, "Edgebreaker: connectivity compression for triangle meshes", IEEE TVCG 5, 1999 (what Draco codes triangles
with).

Tested in `tests/quadpatch/tasks/test_encode.py`.
"""

import numpy as np

from quadpatch.compression.control_mesh import collapse
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.types import TriangleMesh

_BYTES_A_VERTEX = ((1391, 3.33), (3336, 2.88), (8194, 2.65), (16386, 2.36))
# Bytes of a file without vertices.
_LEAST_BYTES = 60.0
_FEWEST_TRIANGLES = 16
_MOST_PROBES = 10_000


def estimated_collapse_bytes(mesh: TriangleMesh, rms: float) -> float | None:
    """Estimate the bytes of edge collapse and Draco.

    Parameters
    ----------
    mesh : TriangleMesh
    rms : float
        Root mean square distance of the surface from the encoded one, in mesh units.

    Returns
    -------
    float or None
        None where even half of the triangles are not close enough.
    """
    used = np.unique(mesh.triangles)
    probes = mesh.vertices[used[:: 1 + len(used) // _MOST_PROBES]]
    found: list[tuple[float, int]] = []
    left = mesh
    while len(left.triangles) > _FEWEST_TRIANGLES:
        left = collapse(left, len(left.triangles) // 2)
        error = float(np.sqrt((distance_to_mesh(probes, left) ** 2).mean()))
        is_stuck = bool(found) and len(left.vertices) >= found[-1][1]
        if is_stuck:
            break
        found.append((max(error, 1e-300), len(left.vertices)))
        if error > rms:
            break
    if found[0][0] > rms:
        return None
    errors, counts = np.log(np.array(found).T)
    order = np.argsort(errors)
    n_vertices = float(np.exp(np.interp(np.log(max(rms, 1e-300)), errors[order], counts[order])))
    places, bytes_each = np.array(_BYTES_A_VERTEX).T
    return _LEAST_BYTES + n_vertices * float(np.interp(np.log(n_vertices), np.log(places), bytes_each))
