"""What an inspection found, in the words of the contract."""

import math
from typing import Any

from jobkit.schema import MeshFacts

# What `quadpatch.report` writes where a file states no unit; the contract says null.
_NO_UNIT = "mesh units"


def mesh_facts(found: dict[str, Any]) -> MeshFacts:
    """Translate the answer of `quadpatch.repair.inspect_file`; lengths are in mesh units."""
    box = found["bounding_box"]
    unit = found["length_unit"]
    return MeshFacts.model_validate(
        {**found, "unit": None if unit == _NO_UNIT else unit, "diagonal": math.dist(box["min"], box["max"])}
    )
