"""Also tests `quadpatch_client.schema.base` and `quadpatch_client.schema.methods`."""

from typing import Any

import pytest
from pydantic import ValidationError

from quadpatch_client.schema import AutoMethod, CnnMethod, DictionaryMethod, JobSpec, SmoothMethod, conflict_of

MESH = {"mesh_id": "a" * 64}


def test_a_mesh_alone_is_a_whole_job() -> None:
    spec = JobSpec.model_validate(MESH)
    assert spec.method == AutoMethod(method="auto", effort="standard")
    assert spec.output.format is None
    assert spec.holes.ids is None


def test_writing_and_reading_gives_the_same_spec() -> None:
    spec = JobSpec.model_validate(
        MESH | {"method": {"method": "cnn", "model": "small@2"}, "holes": {"ids": [1, 2]}, "metadata": {"order": "A"}}
    )
    assert JobSpec.model_validate_json(spec.model_dump_json()) == spec
    assert JobSpec.model_validate(spec.model_dump(mode="json")) == spec


@pytest.mark.parametrize(
    ("name", "kind"),
    [("dictionary", DictionaryMethod), ("cnn", CnnMethod), ("smooth", SmoothMethod), ("auto", AutoMethod)],
)
def test_the_method_is_told_by_its_name(name: str, kind: type[Any]) -> None:
    assert isinstance(JobSpec.model_validate(MESH | {"method": {"method": name}}).method, kind)


@pytest.mark.parametrize(
    "change",
    [
        {"mesh_id": "A" * 64},
        {"mesh_id": "a" * 63},
        {"extra": 1},
        {"method": {"method": "magic"}},
        {"method": {"method": "smooth", "model": "default"}},
        {"method": {"method": "dictionary", "recipe": "ours"}},
        {"method": {"method": "cnn", "recipe": "exact"}},
        {"method": {"method": "smooth", "recipe": "paper"}},
        {"method": {"method": "dictionary", "model": "Upper@1"}},
        {"method": {"method": "dictionary", "model": "name@0"}},
        {"method": {"method": "dictionary", "patches": {"resolution": 7}}},
        {"method": {"method": "dictionary", "fitting": {"steps": 10}}},
        {"method": {"method": "cnn", "model": "self", "fitting": {"steps": 0}}},
        {"method": {"method": "cnn", "model": "self", "fitting": {"steps": 1.5}}},
        {"method": {"method": "cnn", "model": "self", "fitting": {"seconds": 0}}},
        {"method": {"method": "cnn", "model": "self", "fitting": {"seconds": float("inf")}}},
        {"method": {"method": "cnn", "model": "self", "fitting": {"hours": 1}}},
        {"holes": {"max_diameter": 0}},
        {"holes": {"max_diameter": "5"}},
        {"holes": {"max_diameter": float("inf")}},
        {"holes": {"max_diameter": float("nan")}},
        {"holes": {"ids": []}},
        {"holes": {"ids": [-1]}},
        {"holes": {"cap": "round"}},
        {"holes": {"rules": [{}]}},
        {"holes": {"rules": [{"action": "fill"}]}},
        {"holes": {"rules": [{"action": "skip", "ids": []}]}},
        {"holes": {"rules": [{"action": "skip", "kind": "window"}]}},
        {"holes": {"rules": [{"action": "skip", "max_diameter": 0}]}},
        {"holes": {"rules": 33 * [{"action": "skip"}]}},
        {"seed": True},
        {"seed": 1.5},
        {"seed": 2**32},
        {"limits": {"time_s": 0}},
        {"label": "two\nlines"},
        {"label": "a\0b"},
        {"metadata": {f"k{i}": "v" for i in range(17)}},
        {"metadata": {"a key": "v"}},
        {"output": {"format": "gltf"}},
    ],
)
def test_what_is_not_in_the_contract_is_refused(change: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        JobSpec.model_validate(MESH | change)


def test_bridges_are_pairs_of_loops_each_named_once() -> None:
    pairs = [[3, 17], [0, 4]]
    assert JobSpec.model_validate(MESH | {"holes": {"bridges": pairs}}).holes.bridges == pairs
    wrong: list[Any] = [[[3, 3]], [[3, 17], [17, 4]], [[3]], [[3, 4, 5]], [[-1, 2]], [["3", 4]], [3, 4], "3:4", None]
    for bridges in wrong:
        with pytest.raises(ValidationError):
            JobSpec.model_validate(MESH | {"holes": {"bridges": bridges}})
    with pytest.raises(ValidationError, match="drop one of the two"):
        JobSpec.model_validate(MESH | {"holes": {"bridges": pairs}, "weld_tolerance": 0.5})


def test_ids_of_holes_go_with_the_tolerance_that_they_were_found_with() -> None:
    ids = {"ids": [0, 2]}
    assert JobSpec.model_validate(MESH | {"holes": ids, "weld_tolerance": "auto"}).holes.ids == [0, 2]
    assert JobSpec.model_validate(MESH | {"holes": {"max_diameter": 2.0}, "weld_tolerance": 0.5}).weld_tolerance == 0.5
    with pytest.raises(ValidationError, match="drop one of the two"):
        JobSpec.model_validate(MESH | {"holes": ids, "weld_tolerance": 0.5})


@pytest.mark.parametrize("tolerance", [-1.0, float("inf"), float("nan"), "near", None, True])
def test_a_weld_tolerance_is_auto_or_a_length(tolerance: Any) -> None:
    with pytest.raises(ValidationError):
        JobSpec.model_validate(MESH | {"weld_tolerance": tolerance})


def test_a_whole_number_may_be_written_with_a_point() -> None:
    assert JobSpec.model_validate(MESH | {"seed": 7.0}).seed == 7


def test_every_field_of_the_document_says_what_it_is() -> None:
    schema = JobSpec.model_json_schema()
    for definition in (schema, *schema["$defs"].values()):
        for name, field in definition["properties"].items():
            assert field.get("description"), name


def test_a_stored_job_whose_options_exclude_each_other_is_still_read() -> None:
    method = {"method": "dictionary", "model": "self", "recipe": "paper"}
    spec = JobSpec.model_validate(MESH | {"method": method, "holes": {"cap": "flat"}})
    assert JobSpec.model_validate_json(spec.model_dump_json()) == spec
    assert conflict_of(spec) is not None
