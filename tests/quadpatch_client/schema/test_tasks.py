"""Also tests `quadpatch_client.schema.conflicts`."""

import json
from typing import Any

import pytest
from pydantic import ValidationError

from quadpatch_client.schema import (
    SELF,
    TASKS,
    AutoMethod,
    DictionaryMethod,
    JobSpec,
    RepairSpec,
    conflict_of,
    identity_of,
)

MESH = {"mesh_id": "a" * 64}
NAN = {"restore": {"missing": {"kind": "nan"}}}
ENCODE = {"encode": {"max_error": 0.01}}
WHOLE: dict[str, dict[str, Any]] = {"fill": {}, "restore": NAN, "denoise": {}, "encode": ENCODE, "decode": {}}


def spec(task: str, **fields: Any) -> JobSpec:
    return JobSpec.model_validate({**MESH, "task": task, **WHOLE[task], **fields})


@pytest.mark.parametrize("task", WHOLE)
def test_every_task_is_a_whole_job_that_is_read_as_it_was_written(task: str) -> None:
    whole = spec(task)
    assert conflict_of(whole) is None
    assert JobSpec.model_validate_json(whole.model_dump_json()) == whole


def test_the_task_train_is_for_trainings_alone() -> None:
    assert {*WHOLE, "train"} == set(TASKS)
    options = {"model": "walls", "meshes": ["a" * 64]}
    for fields in ({"task": "train"}, {"task": "train", "train": options}, {"train": options}):
        message = conflict_of(JobSpec.model_validate(MESH | fields))
        assert message == "the task train needs several meshes: start it by POST /v1/trainings"


def test_a_spec_of_before_there_were_tasks_fills() -> None:
    assert JobSpec.model_validate(MESH).task == "fill"


@pytest.mark.parametrize("task", WHOLE)
def test_a_task_without_a_method_has_its_own_default(task: str) -> None:
    of_others = DictionaryMethod(method="dictionary", model=SELF)
    assert spec(task).method == (AutoMethod(method="auto") if task == "fill" else of_others)
    assert "method" not in RepairSpec.model_validate({"task": task, **WHOLE[task]}).model_fields_set


@pytest.mark.parametrize(
    "change",
    [
        {"task": "polish"},
        {"task": "restore", "restore": {}},
        {"task": "restore", "restore": {"missing": "nan"}},
        {"task": "restore", "restore": {"missing": {"kind": "nan", "name": "x"}}},
        {"task": "restore", "restore": {"missing": {"kind": "property"}}},
        {"task": "restore", "restore": {"missing": {"kind": "nan"}, "base": "plane"}},
        {"task": "restore", "restore": {"missing": {"kind": "property", "name": "two words"}}},
        {"task": "restore", "restore": {"missing": {"kind": "indices", "indices": []}}},
        {"task": "restore", "restore": {"missing": {"kind": "indices", "indices": [-1]}}},
        {"task": "restore", "restore": {"missing": {"kind": "indices", "indices": [0.5]}}},
        {"task": "denoise", "denoise": {"noise": 0}},
        {"task": "denoise", "denoise": {"max_shift": -1.0}},
        {"task": "denoise", "denoise": {"max_shift": float("inf")}},
        {"task": "denoise", "denoise": {"reference": "scan.ply"}},
        {"task": "denoise", "denoise": {"region": {"kind": "box", "min": [0, 0], "max": [1, 1, 1]}}},
        {"task": "denoise", "denoise": {"region": {"kind": "box", "min": [0, 0, 2.0], "max": [1, 1, 1]}}},
        {"task": "denoise", "denoise": {"region": {"kind": "property", "name": ""}}},
        {"task": "denoise", "denoise": {"region": {"min": [0, 0, 0], "max": [1, 1, 1]}}},
        {"task": "encode", "encode": {}},
        {"task": "encode", "encode": {"max_error": 0}},
        {"task": "decode", "decode": {}},
    ],
)
def test_what_is_not_in_the_contract_is_refused(change: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        JobSpec.model_validate(MESH | change)


@pytest.mark.parametrize(
    ("task", "fields", "words"),
    [
        ("fill", {"denoise": {}}, "denoise holds options of the task denoise; the task of this job is fill"),
        ("denoise", NAN, "restore holds options of the task restore"),
        ("denoise", {"holes": {"ids": [1]}}, "holes goes with the task fill"),
        ("encode", {"weld_tolerance": 0.1}, "weld_tolerance goes with the task fill"),
        ("denoise", {"colours": "harmonic"}, "colours goes with the task fill"),
        ("decode", {"output": {"closeups": True}}, "output.closeups goes with the task fill"),
        ("restore", {"restore": None}, "the task restore needs restore.missing"),
        ("encode", {"encode": None}, "the task encode needs encode.max_error"),
        ("denoise", {"method": {"method": "cnn"}}, "goes by dictionary or smooth, not by the method cnn"),
        ("denoise", {"method": {"method": "auto"}}, "goes by dictionary or smooth, not by the method auto"),
        ("encode", {"method": {"method": "cnn"}}, "goes by dictionary, not by the method cnn"),
        ("decode", {"method": {"method": "smooth"}}, "goes by dictionary, not by the method smooth"),
        ("restore", {"method": {"method": "cnn", "model": "self"}}, "can't be fitted"),
        ("denoise", {"denoise": {"reference": "b" * 64}, "method": {"method": "smooth"}}, "leave method out"),
        ("restore", {"method": {"method": "dictionary", "recipe": "paper"}}, "recipes go with the task fill"),
        ("encode", {"method": {"method": "dictionary", "patches": {"overlap": 1}}}, "leave method.patches.overlap out"),
        (
            "denoise",
            {"denoise": {"reference": "b" * 64}, "method": {"method": "dictionary"}},
            "denoise.reference takes the place of a model",
        ),
        ("encode", {"output": {"format": "ply"}}, "leave output.format out"),
        ("fill", {"method": {"method": "auto", "fitting": {"steps": 5}}}, "method.fitting goes with the effort best"),
        (
            "fill",
            {"method": {"method": "auto", "effort": "fast", "fitting": {"seconds": 5.0}}},
            "method.fitting goes with the effort best",
        ),
        (
            "fill",
            {"method": {"method": "dictionary", "model": "default", "learn_from": "b" * 64}},
            "method.learn_from goes with the model self and the recipe default",
        ),
        (
            "fill",
            {"method": {"method": "dictionary", "model": "self", "recipe": "paper", "learn_from": "b" * 64}},
            "method.learn_from goes with the model self and the recipe default",
        ),
        (
            "fill",
            {"method": {"method": "dictionary", "model": "self", "dictionary": {"atoms": 8}}},
            "method.dictionary goes with the model self and the recipe paper",
        ),
        (
            "encode",
            {"method": {"method": "dictionary", "model": "self", "learn_from": "b" * 64}},
            "method.learn_from goes with the task fill",
        ),
        ("denoise", {"output": {"attributes": ["colours"]}}, "output.attributes goes with the task fill"),
    ],
)
def test_options_that_do_not_go_with_the_task_are_named(task: str, fields: dict[str, Any], words: str) -> None:
    """They are read all the same: a stored job stays readable."""
    assert words in str(conflict_of(spec(task, **fields)))


def test_a_reference_goes_with_the_model_that_is_the_default_of_denoising() -> None:
    assert conflict_of(spec("denoise", denoise={"reference": "b" * 64, "noise": 0.1, "max_shift": 0.3})) is None


@pytest.mark.parametrize(("task", "method"), [("restore", "smooth"), ("restore", "cnn"), ("denoise", "smooth")])
def test_some_tasks_take_other_methods(task: str, method: str) -> None:
    assert conflict_of(spec(task, method={"method": method})) is None


def test_the_identity_of_a_fill_is_what_it_was_before_there_were_tasks() -> None:
    text = identity_of(JobSpec.model_validate(MESH | {"seed": 3}))
    assert list(json.loads(text)) == [
        "method",
        "holes",
        "weld_tolerance",
        "output",
        "limits",
        "seed",
        "label",
        "metadata",
        "mesh_id",
        "mesh_name",
    ]
    assert identity_of(JobSpec.model_validate(MESH | {"task": "fill", "seed": 3})) == text
    assert "bridges" not in json.loads(text)["holes"]


def test_what_came_later_is_part_of_the_identity_where_it_is_used() -> None:
    method = {"method": "dictionary", "model": "self"}
    plain = identity_of(JobSpec.model_validate(MESH | {"method": method}))
    assert set(json.loads(plain)["method"]) == {"method", "model", "recipe", "patches"}
    assert list(json.loads(plain)["output"]) == ["format", "preview", "closeups"]
    assert "length_unit" not in json.loads(plain)
    for changed in (
        {"method": method | {"learn_from": "b" * 64}},
        {"method": method | {"recipe": "paper", "dictionary": {"atoms": 8}}},
        {"method": method, "length_unit": "inch"},
        {"method": method, "output": {"attributes": []}},
    ):
        assert identity_of(JobSpec.model_validate(MESH | changed)) != plain


def test_a_mesh_to_learn_from_is_the_reference_of_a_job() -> None:
    method = {"method": "dictionary", "model": "self", "learn_from": "b" * 64}
    learning = JobSpec.model_validate(MESH | {"method": method})
    assert conflict_of(learning) is None
    assert learning.reference_id == "b" * 64
    assert JobSpec.model_validate(MESH).reference_id is None


def test_bridges_are_part_of_the_identity_where_there_are_any() -> None:
    plain, *bridged = (
        identity_of(JobSpec.model_validate(MESH | {"holes": {"bridges": pairs}})) for pairs in ([], [[0, 1]], [[1, 0]])
    )
    assert identity_of(JobSpec.model_validate(MESH)) == plain
    assert len({plain, *bridged}) == 3


def test_the_identity_of_a_task_is_what_it_was_before_there_were_colours() -> None:
    plain = spec("denoise")
    assert "colours" not in json.loads(identity_of(plain))
    assert "task" in json.loads(identity_of(plain))
    asked = JobSpec.model_validate(MESH | {"colours": "harmonic"})
    assert json.loads(identity_of(asked))["colours"] == "harmonic"
    assert "task" not in json.loads(identity_of(asked))


def test_other_tasks_have_an_identity_of_their_own() -> None:
    specs = [*map(spec, WHOLE), spec("denoise", denoise={}), spec("encode", encode={"max_error": 0.02})]
    assert len({identity_of(one) for one in specs}) == len(specs)


@pytest.mark.parametrize("task", TASKS)
def test_every_field_of_the_document_says_what_it_is(task: str) -> None:
    schema = JobSpec.model_json_schema()
    assert task in schema["properties"]["task"]["enum"]
    for definition in (schema, *schema["$defs"].values()):
        for name, field in definition["properties"].items():
            assert field.get("description"), name
