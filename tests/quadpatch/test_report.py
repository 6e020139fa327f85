import json

import numpy as np

from quadpatch.report import json_ready


def test_every_value_of_numpy_becomes_a_plain_one() -> None:
    value = {
        "count": np.int64(3),
        "is_manifold": np.bool_(True),
        "length": np.float32(0.5),
        "box": np.array([[1.0, np.nan], [np.inf, 2.0]]),
        "ids": (1, np.uint8(2)),
        "nested": [{"area": np.float64(-np.inf)}],
        "name": "sm\n\ud800ooth",
        "nothing": None,
    }
    expected = {
        "count": 3,
        "is_manifold": True,
        "length": 0.5,
        "box": [[1.0, None], [None, 2.0]],
        "ids": [1, 2],
        "nested": [{"area": None}],
        "name": "sm\\n\\ud800ooth",
        "nothing": None,
    }
    assert json.loads(json.dumps(json_ready(value), allow_nan=False)) == expected
