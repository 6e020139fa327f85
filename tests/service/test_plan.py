"""The service may not import the method, so its copy of the selection rule is held to the original here."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from jobkit.schema import Hole, HoleSelection
from quadpatch.mesh import holes as method
from quadpatch.options import HoleOptions
from service.plan import reason_to_skip

LENGTHS = st.floats(0.1, 100.0)
AREAS = st.floats(0.01, 1e8)
HOLES = st.lists(st.tuples(LENGTHS, LENGTHS, AREAS, st.booleans(), st.booleans()), min_size=1, max_size=8)


@settings(max_examples=200, deadline=None)
@given(
    measures=HOLES,
    diagonal=LENGTHS,
    max_diameter=st.none() | LENGTHS,
    max_perimeter=st.none() | LENGTHS,
    all_but_largest=st.booleans(),
    ids=st.none() | st.lists(st.integers(0, 7), min_size=1, max_size=4),
)
def test_a_plan_selects_what_the_method_selects(
    measures: list[tuple[float, float, float, bool, bool]],
    diagonal: float,
    max_diameter: float | None,
    max_perimeter: float | None,
    all_but_largest: bool,
    ids: list[int] | None,
) -> None:
    ids = [i for i in ids if i < len(measures)] or None if ids else None
    wire = HoleSelection(
        max_diameter=max_diameter, max_perimeter=max_perimeter, all_but_largest=all_but_largest, ids=ids
    )
    options = HoleOptions(max_diameter, max_perimeter, all_but_largest, None if ids is None else tuple(ids))
    loop = np.zeros(3, dtype=np.int64)
    theirs = [
        method.Hole(i, loop, perimeter, diameter, area, 0.0, is_manifold, is_border)
        for i, (perimeter, diameter, area, is_manifold, is_border) in enumerate(measures)
    ]
    ours = [
        Hole(id=i, perimeter=p, diameter=d, area=a, planarity=0.0, edges=3, is_manifold=m, is_border=b)
        for i, (p, d, a, m, b) in enumerate(measures)
    ]
    selection = method.select_holes(theirs, options, diagonal)
    expected = {hole.id: None for hole in selection.chosen} | {i: code for i, (code, _) in selection.skipped.items()}
    assert {hole.id: reason_to_skip(hole, wire, diagonal) for hole in ours} == expected
