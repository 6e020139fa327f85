"""Values that any JSON encoder takes."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from quadpatch.printable import printable


def json_ready(value: Any) -> Any:
    """Turn nested values into plain ones.

    Parameters
    ----------
    value : Any
        Mappings, sequences, arrays, numpy scalars and plain values.

    Returns
    -------
    Any
        Dicts, lists, printable strings, booleans, integers, finite floats and None. JSON knows no NaN and no
        infinity: both become None.
    """
    if isinstance(value, Mapping):
        return {printable(str(name)): json_ready(item) for name, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return json_ready(value.tolist())
    if isinstance(value, list | tuple):
        return [json_ready(item) for item in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, str):
        return printable(value)
    return value
