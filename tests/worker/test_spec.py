from dataclasses import replace
from typing import Any, get_args

import pytest

import quadpatch.options
import quadpatch.restoration.restore
import quadpatch_client.schema
from jobkit.jobs.attempts import StartedAttempt
from jobkit.jobs.endings import Attempt
from jobkit.meshes import MeshSource
from jobkit.models.resolution import PAPER_NORMALISATION
from quadpatch.compression.encode import EncodeOptions
from quadpatch.denoising.denoise import DenoiseOptions
from quadpatch.inpainters.model_file import RECIPES
from quadpatch.options import HoleOptions, HoleRule, NetworkOptions, PatchOptions, RepairOptions
from quadpatch.restoration.restore import RestoreOptions
from quadpatch_client.schema import Fitting, Job, JobSpec
from quadpatch_rules.option_words import Effort, Recipe
from tests.quadpatch_client.wire_jobs import body
from worker.engine.limits import EngineLimits
from worker.spec import (
    filled_by,
    inspect_request,
    job_request,
    method_options,
    output_format,
    source_name,
    task_options,
    who_asked,
)

MESH_ID = "0" * 64
OPTIONS: dict[str, Any] = {
    "restore": RestoreOptions,
    "denoise": DenoiseOptions,
    "encode": EncodeOptions,
}
LIMITS = EngineLimits(time_s=900.0, memory_mb=4096, n_threads=2)


def source(mesh_format: Any = "ply", filename: str | None = None) -> MeshSource:
    return MeshSource(MESH_ID, MESH_ID, "meshes/00/00", filename, mesh_format)


def spec(**fields: Any) -> JobSpec:
    return JobSpec.model_validate({"mesh_id": MESH_ID, **fields})


def test_a_job_without_wishes_is_a_repair_with_all_defaults() -> None:
    assert RepairOptions.from_dict(method_options(spec(), LIMITS.time_s)) == RepairOptions()
    for method in (
        {"method": "auto"},
        {"method": "dictionary"},
        {"method": "smooth"},
        {"method": "cnn"},
    ):
        assert RepairOptions.from_dict(method_options(spec(method=method), LIMITS.time_s)) == RepairOptions()


def test_every_option_of_a_job_reaches_the_method() -> None:
    job = spec(
        method={
            **{"method": "dictionary", "model": "self"},
            "patches": {"length": 2.5, "resolution": 16, "overlap": 3},
        },
        holes={
            **{"max_diameter": 9.0, "max_perimeter": 30.0, "all_but_largest": True, "ids": [4, 1]},
            **{"include_borders": True, "cap": "flat", "bridges": [[3, 17]]},
            "rules": [
                {"action": "skip", "ids": [4]},
                {"action": "flat", "kind": "open_end", "min_diameter": 1.0, "max_diameter": 2.0, "max_perimeter": 3.0},
            ],
        },
        seed=7,
    )
    rules = (HoleRule("skip", (4,)), HoleRule("flat", None, "open_end", 1.0, 2.0, 3.0))
    assert RepairOptions.from_dict(method_options(job, LIMITS.time_s)) == RepairOptions(
        HoleOptions(9.0, 30.0, True, (4, 1), True, "flat", rules, ((3, 17),)), PatchOptions(2.5, 16, 3), 7
    )
    by_paper = spec(method={"method": "dictionary", "model": "self", "recipe": "paper"})
    assert RepairOptions.from_dict(method_options(by_paper, LIMITS.time_s)) == RepairOptions(recipe="paper")


def test_the_weld_tolerance_of_a_job_reaches_the_method() -> None:
    for tolerance in (0.0, 0.25, "auto"):
        options = RepairOptions.from_dict(method_options(spec(weld_tolerance=tolerance), LIMITS.time_s))
        assert options.weld_tolerance == tolerance


def test_the_colours_of_a_job_reach_the_method() -> None:
    for colours in ("auto", "harmonic"):
        options = RepairOptions.from_dict(method_options(spec(colours=colours), LIMITS.time_s))
        assert options.colours == colours


def test_how_long_to_fit_a_network_reaches_the_method() -> None:
    rest = {"fitting": {"steps": 30, "seconds": 45.0}, "patches": {"length": 2.0}}
    expected = RepairOptions(patches=PatchOptions(length=2.0), network=NetworkOptions(30, 45.0))
    method = {"method": "cnn", "model": "self", **rest}
    assert RepairOptions.from_dict(method_options(spec(method=method), LIMITS.time_s)) == expected
    method = {"method": "auto", "effort": "best", **rest}
    options = RepairOptions.from_dict(method_options(spec(method=method), LIMITS.time_s))
    assert options == replace(expected, effort="best")


@pytest.mark.parametrize(
    ("method", "by"),
    [
        ({"method": "smooth"}, "geometry"),
        ({"method": "auto", "effort": "fast"}, "geometry"),
        ({"method": "auto"}, "model"),
        ({"method": "cnn"}, "model"),
        ({"method": "cnn", "model": "self"}, "fitting"),
        ({"method": "auto", "effort": "best"}, "fitting"),
    ],
)
def test_what_fills_the_holes_goes_by_method_and_effort(method: dict[str, str], by: str) -> None:
    assert filled_by(spec(method=method).method) == by


@pytest.mark.parametrize("effort", get_args(Effort))
def test_an_effort_reaches_the_method(effort: Effort) -> None:
    options = RepairOptions.from_dict(method_options(spec(method={"method": "auto", "effort": effort}), LIMITS.time_s))
    assert replace(options, network=NetworkOptions()) == RepairOptions(effort=effort)


@pytest.mark.parametrize(
    ("method", "model"),
    [({"method": "cnn", "model": "self"}, "self-network"), ({"method": "auto", "effort": "best"}, "auto")],
)
def test_fitting_leaves_a_third_of_the_time_to_the_rest_of_the_job(method: dict[str, Any], model: str) -> None:
    for asked, seconds in ((None, 60.0), (70.0, 60.0), (20.0, 20.0)):
        job = spec(method={**method, "fitting": {"seconds": asked}}, limits={"time_s": 90.0})
        request = job_request(job, source(), model, LIMITS)
        assert request.options["network"] == {"steps": NetworkOptions().steps, "seconds": pytest.approx(seconds)}
        options = RepairOptions.from_dict(request.options)
        assert replace(options, network=NetworkOptions()) == RepairOptions(effort=method.get("effort", "standard"))


def test_every_recipe_has_a_normalisation_of_its_models() -> None:
    assert set(RECIPES.values()) == set(get_args(Recipe))
    assert RECIPES[PAPER_NORMALISATION] == "paper"
    assert list(RECIPES.values()).count("paper") == 1


def test_every_field_of_the_contract_is_one_of_the_method() -> None:
    options = method_options(spec(), LIMITS.time_s)
    assert set(options["holes"]) == set(vars(HoleOptions()))
    assert set(options["patches"]) == set(vars(PatchOptions()))
    assert set(Fitting.model_fields) == set(vars(NetworkOptions()))


@pytest.mark.parametrize(
    ("mesh_format", "filename", "asked", "name", "output"),
    [
        ("stl", "part.stl", None, "source.stl", "stl"),
        ("ply", "part.ply", "obj", "source.ply", "obj"),
        ("gltf", "part.gltf", None, "source.gltf", "glb"),
        (None, "PART.OFF", None, "source.off", "off"),
        (None, "part.xyz", None, "source", "ply"),
        (None, None, None, "source", "ply"),
    ],
)
def test_a_station_gets_back_the_format_that_it_sent(
    mesh_format: Any, filename: str | None, asked: str | None, name: str, output: str
) -> None:
    mesh = source(mesh_format, filename)
    assert source_name(mesh) == f"mesh/{name}"
    assert output_format(spec(output={"format": asked}), mesh) == output


def test_a_filename_never_leads_out_of_the_folder() -> None:
    assert source_name(source(None, "../../etc/passwd.ply")) == "mesh/source.ply"
    assert source_name(source(None, "x.ply/../../y")) == "mesh/source"


def test_a_job_can_lower_the_limits_and_never_raise_them() -> None:
    tighter_limits = job_request(spec(limits={"time_s": 10.0, "memory_mb": 512}), source(), "smooth", LIMITS)
    raised = job_request(spec(limits={"time_s": 5000.0, "memory_mb": 65536}), source(), "smooth", LIMITS)
    assert (tighter_limits.limits.time_s, tighter_limits.limits.memory_mb) == (10.0, 512)
    assert raised.limits == LIMITS


TASKS: dict[str, dict[str, Any]] = {
    "restore": {"restore": {"missing": {"kind": "nan"}}},
    "denoise": {},
    "encode": {"encode": {"max_error": 0.5, "keep_connectivity": True}},
    "decode": {},
}


@pytest.mark.parametrize(
    ("task", "asked", "output"),
    [
        ("restore", None, "restored.stl"),
        ("restore", "ply", "restored.ply"),
        ("denoise", None, "denoised.stl"),
        ("encode", None, "encoded.qpz"),
        ("decode", "obj", "decoded.obj"),
    ],
)
def test_a_task_is_asked_of_the_engine_under_its_name(task: str, asked: str | None, output: str) -> None:
    job = spec(task=task, **TASKS[task], output={"format": asked, "preview": False}, limits={"time_s": 9.0})
    request = job_request(job, source("stl"), "self", LIMITS)
    assert (request.task, request.output, request.with_preview, request.with_close_ups) == (task, output, False, False)
    assert (request.limits.time_s, request.reference) == (9.0, "")


def test_a_decoded_surface_is_a_ply_unless_another_format_is_asked_for() -> None:
    assert output_format(spec(task="decode"), source("qpz", "scan.qpz")) == "ply"
    assert source_name(source("qpz", "scan.qpz")) == "mesh/source.qpz"


def test_every_option_of_a_task_reaches_the_method() -> None:
    patches = {"length": 2.5, "resolution": 16, "overlap": 3, "preset": None}
    method: dict[str, Any] = {"method": "dictionary", "model": "self", "patches": patches}
    box = {"min": [0.0, 0.0, 0.0], "max": [1.0, 2.0, 3.0]}
    options = {"noise": 0.1, "max_shift": 0.3, "region": {"kind": "box", **box}, "reference": "1" * 64}
    rest = {"seed": 7, "length_unit": "inch"}
    job = spec(task="denoise", method=method, denoise=options, **rest)
    assert task_options(job) == {"noise": 0.1, "max_shift": 0.3, "region": box, "patches": patches, **rest}
    by_poisson = spec(task="restore", restore={"missing": {"kind": "nan"}, "base": "poisson"})
    assert RestoreOptions.from_dict(task_options(by_poisson)) == RestoreOptions(base="poisson")
    by_property = spec(task="denoise", denoise={"region": {"kind": "property", "name": "rough"}})
    assert DenoiseOptions.from_dict(task_options(by_property)) == DenoiseOptions(region="rough")
    method["patches"]["overlap"] = None
    job = spec(task="encode", **TASKS["encode"], method=method)
    none = {"seed": 0, "length_unit": None}
    assert task_options(job) == {"max_error": 0.5, "keep_connectivity": True, "patches": patches, **none}
    for task, kind in OPTIONS.items():
        kind.from_dict(task_options(spec(task=task, **TASKS[task])))


def test_the_bases_of_a_restoration_are_those_of_the_method() -> None:
    assert get_args(quadpatch_client.schema.RestorationBase) == get_args(quadpatch.restoration.restore.Base)


def test_a_reference_lies_in_a_folder_of_its_own() -> None:
    request = job_request(spec(task="denoise"), source("stl"), "self", LIMITS, source("ply", "clean.ply"))
    assert (request.source, request.reference) == ("mesh/source.stl", "reference/source.ply")


@pytest.mark.parametrize(
    "missing", [{"kind": "nan"}, {"kind": "property", "name": "lost"}, {"kind": "indices", "indices": [4, 7]}]
)
def test_the_engine_is_told_which_vertices_are_missing(missing: dict[str, Any]) -> None:
    request = job_request(spec(task="restore", restore={"missing": missing}), source(), "self", LIMITS)
    assert request.missing == missing


def test_an_inspection_writes_no_mesh() -> None:
    request = inspect_request(source(), LIMITS)
    assert (request.task, request.output, request.model) == ("inspect", "", "")


def test_each_picture_is_drawn_where_it_is_asked_for() -> None:
    for preview in (False, True):
        for closeups in (False, True):
            job = spec(output={"preview": preview, "closeups": closeups})
            request = job_request(job, source(), "smooth", LIMITS)
            assert (request.with_preview, request.with_close_ups) == (preview, closeups)
    default = job_request(spec(), source(), "smooth", LIMITS)
    assert (default.with_preview, default.with_close_ups) == (True, False)


def test_who_asked_is_told_where_a_page_is_asked_for() -> None:
    output = {"html_report": True}
    asked = spec(output=output, label="part 7", metadata={"order": "A-17"}, mesh_name="bust.ply")
    job = Job.model_validate_json(body("queued", 1, spec=asked.model_dump(), mesh_name="bust.ply"))
    attempt = Attempt(job.id, 1)
    told = {
        "job_id": job.id,
        "tenant": "museum",
        "request_id": "r-1",
        "label": "part 7",
        "metadata": {"order": "A-17"},
        "rule": None,
        "acceptance": None,
        "mesh_name": "bust.ply",
    }
    assert who_asked(StartedAttempt(attempt, job, "museum", "r-1")) == told
    by_key = StartedAttempt(attempt, job, "museum", "r-1", asked_by="station 4")
    assert who_asked(by_key) == told | {"asked_by": "station 4"}
    plain = Job.model_validate_json(body("queued", 1, spec=spec().model_dump()))
    assert who_asked(StartedAttempt(attempt, plain, "museum")) is None


def test_what_is_kept_of_a_calibration_goes_by_the_bytes_of_the_mesh_and_how_they_are_read() -> None:
    as_ply, as_stl = (job_request(spec(), source(form), "smooth", LIMITS).scan for form in ("ply", "stl"))
    assert as_ply != as_stl
    assert source("ply").mesh_id in as_ply
    assert not job_request(spec(task="denoise"), source("stl"), "self", LIMITS, source("ply", "clean.ply")).scan
