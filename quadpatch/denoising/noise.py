"""How strong the noise of a mesh is, from the mesh alone.

A high-order difference, (I - A)^p x with A the average over the neighbours, takes the shape out of a surface and
leaves noise. What it leaves is compared with what it leaves of noise of known strength on the same mesh. Creases and
detail add to it at some vertices, so a quantile of the magnitudes counts; and they add to every order, so the smallest
answer does. What is as fine as the mesh and everywhere counts as noise.

References
----------
D. Donoho, I. Johnstone, "Ideal spatial adaptation by wavelet shrinkage", Biometrika 81, 1994: the median of the finest
differences as a robust measure of noise.
"""

import numpy as np

from quadpatch.mesh.normals import vertex_normals
from quadpatch.mesh.smoothing import laplacian_smooth, neighbour_average
from quadpatch.types import FloatArray, TriangleMesh

# Orders p of the difference. One of 2 still sees the curvature of coarse meshes; beyond 5 nothing is gained.
_ORDERS = (2, 3, 4, 5)
# Quantile of the residuals that is compared, a little below the median: creases add to the larger ones.
_QUANTILE = 0.4
# Normals of the noisy mesh itself point anywhere.
_NORMAL_ITERATIONS = 3
# A residual below this share of the coordinates is their rounding.
_ROUNDING = 1e-12
_SEED = 20_111


def estimate_noise(mesh: TriangleMesh) -> float:
    """Estimate the standard deviation of independent noise along the normals.

    Parameters
    ----------
    mesh : TriangleMesh
        Vertices that no triangle uses don't count.

    Returns
    -------
    float
        In mesh units. 0 where the surface shows no more than rounding, and for a mesh without triangles.
    """
    used = np.unique(mesh.triangles)
    if not len(used):
        return 0.0
    average = neighbour_average(mesh.triangles, len(mesh.vertices))
    smooth = laplacian_smooth(mesh, _NORMAL_ITERATIONS)
    normals = vertex_normals(smooth.vertices, smooth.triangles)
    unit_noise = np.random.default_rng(_SEED).normal(size=(len(normals), 1)) * normals
    centred = mesh.vertices - mesh.vertices[used].mean(axis=0)
    both, estimates = np.concatenate([centred, unit_noise], axis=1), []
    for order in range(1, max(_ORDERS) + 1):
        both = both - average @ both
        if order in _ORDERS:
            measured, simulated = (np.abs(np.einsum("ij,ij->i", both[used, k : k + 3], normals[used])) for k in (0, 3))
            estimates.append(_ratio(measured, simulated))
    noise = min(estimates)
    return noise if noise > _ROUNDING * float(np.abs(centred[used]).max()) else 0.0


def _ratio(measured: FloatArray, simulated: FloatArray) -> float:
    at_unit_noise = float(np.quantile(simulated, _QUANTILE))
    return float(np.quantile(measured, _QUANTILE)) / at_unit_noise if at_unit_noise > 0 else 0.0
