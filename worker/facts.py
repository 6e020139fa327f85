"""The result of an inspection, translated to the wire schema."""

import math
from typing import Any

from quadpatch_client.schema import MeshFacts

# What `quadpatch.report` writes where a file states no unit; the contract says null.
_NO_UNIT = "mesh units"


def mesh_facts(inspection: dict[str, Any]) -> MeshFacts:
    """Translate the answer of `quadpatch.tasks.inspect.inspect_any`; lengths are in mesh units."""
    bounding_box = inspection.get("bounding_box")
    unit = inspection["length_unit"]
    return MeshFacts.model_validate(
        {
            **inspection,
            "unit": None if unit == _NO_UNIT else unit,
            "diagonal": None if bounding_box is None else math.dist(bounding_box["min"], bounding_box["max"]),
        }
    )
