from typing import Any

import pytest

from quadpatch_client.schema import Hole, MeshFacts

# As an analysis by the first version wrote it into the database.
OLD_HOLE: dict[str, Any] = {
    **{"id": 0, "perimeter": 9.0, "diameter": 3.0, "area": 7.0, "planarity": 0.01, "edges": 12},
    "is_manifold": True,
}


@pytest.mark.parametrize(("is_border", "kind"), [(True, "border"), (False, "hole")])
def test_holes_of_earlier_analyses_are_read(is_border: bool, kind: str) -> None:
    hole = Hole.model_validate(OLD_HOLE | {"is_border": is_border})
    assert (hole.kind, hole.is_border) == (kind, is_border)
    assert (hole.centre, hole.normal, hole.bounding_box) == (None, None, None)
    assert Hole.model_validate_json(hole.model_dump_json()) == hole


def test_facts_of_earlier_analyses_are_read() -> None:
    box = {"min": [0.0, 0.0, 0.0], "max": [1.0, 1.0, 1.0]}
    facts = MeshFacts.model_validate(
        {
            **{"format": "ply", "unit": None, "vertices": 10, "triangles": 12, "bounding_box": box},
            **{"diagonal": 1.7, "mean_edge_length": 0.1, "holes": [OLD_HOLE, OLD_HOLE | {"id": 1, "is_border": True}]},
        }
    )
    assert [hole.kind for hole in facts.holes] == ["hole", "border"]
