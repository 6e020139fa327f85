r"""Weights of several denoised surfaces, by the error that each of them and any mean of them is expected to have.

Let y be the noisy vertices along their normals, and y + d_k what filter k makes of them. With weights w the mean
squared error is, but for a constant, that of Stein's unbiased risk estimate,

.. math:: w^T D^T Q D w + 2 \sigma^2 \sum_k w_k\, \mathrm{tr}(Q\, \partial d_k / \partial y),

Q saying what counts: positions, and slopes along the edges, which are what normals are made of. The traces are found by
applying every filter once more, to vertices that one random vector b has moved a little (Ramani et al.). The least over
weights of 0 or more whose sum is 1 at most is a problem of non-negative least squares; what is missing to a sum of 1 is
the share of the noisy vertices themselves. Without these bounds the noise of a single b would do harm.

References
----------
C. Stein, "Estimation of the mean of a multivariate normal distribution", Annals of Statistics 9, 1981.
S. Ramani, T. Blu, M. Unser, "Monte-Carlo SURE", IEEE Transactions on Image Processing 17, 2008.
F. Luisier, T. Blu, M. Unser, "A new SURE approach to image denoising: interscale orthonormal wavelet thresholding",
IEEE Transactions on Image Processing 16, 2007: weights of several filters by their common risk.
"""

import numpy as np
from scipy.optimize import nnls

from quadpatch.types import FloatArray, IntArray

# How much a squared difference along an edge counts, to a squared distance. Between 0 and 3 it hardly matters.
_SLOPE_WEIGHT = 0.3
# Length of the vector b, in standard deviations of the noise: short, since filters of normals switch between answers.
PROBE_SHARE = 0.05
# The noise counts as so much stronger. One that is taken for too weak keeps some of the noisy vertices, which harms
# creases and flat faces more than a little smoothing harms detail.
_CAUTION = 1.1
# Weight of the bound on the sum, to the risk itself.
_BOUND = 1e3
_RIDGE = 1e-9


def least_risk_weights(
    shifts: FloatArray, responses: FloatArray, probe: FloatArray, edges: IntArray, noise: float
) -> FloatArray:
    """Weigh filters by Stein's risk.

    Parameters
    ----------
    shifts : (n, n_filters) float64
        How far each filter moves each vertex along its normal, in mesh units.
    responses : (n, n_filters) float64
        How much that changes where the vertices are moved by the probe, divided by the length of that move.
    probe : (n,) float64
        Entries -1 or 1; 0 for vertices that don't count.
    edges : (m, 2) int64
    noise : float
        Standard deviation, in mesh units.

    Returns
    -------
    (n_filters,) float64
        0 or more, with a sum of 1 at most.
    """
    along = np.sqrt(_SLOPE_WEIGHT)
    both, answers, pushes = (
        np.concatenate([values, along * (values[edges[:, 0]] - values[edges[:, 1]])])
        for values in (shifts / (_CAUTION * noise), responses, probe)
    )
    gram, trace = both.T @ both, pushes @ answers
    count = len(gram)
    scale = float(np.trace(gram)) / count
    if not scale > 0:
        return np.zeros(count)
    factor = np.linalg.cholesky(gram + _RIDGE * scale * np.eye(count))
    bound = _BOUND * np.sqrt(scale)
    # The last column is the share of the noisy vertices.
    system = np.concatenate([np.pad(factor.T, ((0, 0), (0, 1))), np.full((1, count + 1), bound)])
    found, _ = nnls(system, np.append(-np.linalg.solve(factor, trace), bound))
    return np.asarray(found[:count])
