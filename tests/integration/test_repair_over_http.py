import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from quadpatch.formats.reading import read_scan
from quadpatch.inpainters.model_file import shipped_model
from quadpatch.model_choice import BASE_NETWORK
from quadpatch.repair import inspect_file
from quadpatch_client.schema import JobSpec, JobState, MeshState
from quadpatch_client.sdk import Client
from tests.integration.conftest import ply_bytes, punched_relief, stl_bytes
from tests.quadpatch.shapes import punched, relief, write_ply
from tests.waiting import GUARD_S

SMOOTH = {"method": "smooth"}
SELF = {"method": "dictionary", "model": "self"}


def spec(mesh_id: str, **fields: Any) -> JobSpec:
    """A job without a picture, unless it asks for one: drawing takes longer than repairing."""
    return JobSpec.model_validate({"mesh_id": mesh_id, "output": {"preview": False}, **fields})


@pytest.mark.parametrize("method", [SMOOTH, SELF], ids=["smooth", "self"])
@pytest.mark.parametrize("name", ["float.ply", "double.ply", "binary.stl"])
def test_measured_vertices_and_faces_keep_their_bits_and_their_order(
    client: Client, relief_file: Callable[[str], Path], tmp_path: Path, name: str, method: dict[str, str]
) -> None:
    source, output = relief_file(name), tmp_path / f"repaired-{name}"
    mesh = client.upload(source)
    job = client.wait(client.create_job(spec(mesh.id, method=method)).id, timeout_s=GUARD_S)
    client.download(job, "result", output)
    before, after = read_scan(source), read_scan(output)
    assert np.array_equal(after.vertices[: len(before.vertices)], before.vertices)
    assert np.array_equal(after.triangles[: len(before.triangles)], before.triangles)
    assert len(after.triangles) > len(before.triangles)
    assert [hole["perimeter"] > 2 for hole in inspect_file(output)["holes"]] == [True]


@pytest.mark.parametrize(
    ("method", "name"), [("dictionary", "general-paper@1"), ("cnn", "general-small_4x@2")], ids=["dictionary", "cnn"]
)
def test_the_recipe_of_the_paper_works_where_no_model_is_named(
    client: Client, relief_file: Callable[[str], Path], tmp_path: Path, method: str, name: str
) -> None:
    mesh = client.upload(relief_file("float.ply"))
    job = client.create_job(spec(mesh.id, method={"method": method, "recipe": "paper"}))
    assert f"{job.model.name}@{job.model.version}" == name
    job = client.wait(job.id, timeout_s=GUARD_S)
    client.download(job, "report", tmp_path / "report.json")
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["options"]["recipe"] == "paper"
    # Quads leave the border of the sheet out, and with it the outer two of the holes; they are closed all the same.
    assert report["counts"]["filled"] >= 2
    assert report["counts"]["filled"] + report["counts"]["filled_smooth"] == 4
    assert {hole["confidence"] for hole in report["holes"]} == {None}


def test_without_a_word_about_the_method_models_compete_and_the_report_names_them(
    client: Client, tmp_path: Path
) -> None:
    scan = punched(relief(100, 2.0, 0.03, 10), *[(x, y, 0.0) for x in (-0.5, 0.5) for y in (-0.45, 0.5)], radius=0.1)
    mesh = client.upload(write_ply(tmp_path / "relief.ply", scan))
    job = client.create_job(spec(mesh.id))
    assert (job.model.requested, job.model.kind, job.model.name) == ("auto", "auto", None)
    job = client.wait(job.id, timeout_s=GUARD_S)
    assert job.state == JobState.SUCCEEDED, job.error
    client.download(job, "report", tmp_path / "report.json")
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["counts"]["filled"] + report["counts"]["filled_smooth"] == 4
    model = report["model"]
    assert (model["name"], model["effort"]) == ("auto", "standard")
    geometry, *others = model["trials"]
    assert geometry["models"] == {}
    # The mean of both is tried where neither was dropped on the first calibration holes.
    assert [set(trial["models"]) for trial in others[:2]] == [{"self"}, {BASE_NETWORK}]
    assert [set(trial["models"]) for trial in others[2:]] in ([], [{"self", BASE_NETWORK}])
    believed = report["patches"]["believed_share"] > 0
    assert (sum(model["shares"].values()) == pytest.approx(1.0)) is believed


def test_the_effort_fast_gives_the_bytes_of_the_method_smooth(
    client: Client, relief_file: Callable[[str], Path], tmp_path: Path
) -> None:
    mesh = client.upload(relief_file("float.ply"))
    for name, method in (("fast", {"method": "auto", "effort": "fast"}), ("smooth", SMOOTH)):
        job = client.wait(client.create_job(spec(mesh.id, method=method)).id, timeout_s=GUARD_S)
        client.download(job, "result", tmp_path / name)
    assert (tmp_path / "fast").read_bytes() == (tmp_path / "smooth").read_bytes()


def test_a_job_leaves_a_report_and_a_picture_that_fit_its_facts(
    client: Client, relief_file: Callable[[str], Path], tmp_path: Path
) -> None:
    mesh = client.upload(relief_file("float.ply"))
    job = client.wait(client.create_job(spec(mesh.id, method=SMOOTH, output={"preview": True})).id, timeout_s=GUARD_S)
    client.download(job, "report", tmp_path / "report.json")
    client.download(job, "preview", tmp_path / "preview.png")
    report = json.loads((tmp_path / "report.json").read_text())
    assert job.state == JobState.SUCCEEDED
    assert job.percent == 100
    assert job.result is not None
    assert job.result.holes.model_dump() == report["counts"]
    assert job.result.holes.found == len(report["holes"]) == 5
    assert job.result.holes.skipped == 1
    assert job.result.new_triangles == sum(hole["new_triangles"] for hole in report["holes"])
    assert [stage["name"] for stage in report["stages"]][-2:] == ["write", "preview"]
    assert (tmp_path / "preview.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(("name", "asked"), [("binary.stl", None), ("float.ply", "stl")])
def test_facets_that_share_no_vertex_have_their_picture(
    client: Client, tmp_path: Path, name: str, asked: str | None
) -> None:
    """About 5,000 facets, each under a hundredth of the area."""
    vertices, triangles = punched_relief(54)
    source = tmp_path / name
    write = stl_bytes if name.endswith(".stl") else ply_bytes
    source.write_bytes(write(vertices, triangles))
    assert len(triangles) > 5000
    mesh = client.upload(source)
    job = client.wait(
        client.create_job(spec(mesh.id, method=SMOOTH, output={"format": asked, "preview": True})).id, timeout_s=240
    )
    client.download(job, "result", tmp_path / "out.stl")
    client.download(job, "preview", tmp_path / "out.png")
    client.download(job, "report", tmp_path / "report.json")
    holes = json.loads((tmp_path / "report.json").read_text())["holes"]
    assert {bool(hole["energies"]) for hole in holes if hole["new_triangles"]} == {True}
    assert job.state == JobState.SUCCEEDED
    assert len(read_scan(tmp_path / "out.stl").triangles) > len(triangles)
    assert (tmp_path / "out.png").read_bytes().startswith(b"\x89PNG")


def test_a_job_is_named_after_the_file_that_came_for_it(client: Client, relief_file: Callable[[str], Path]) -> None:
    """The second upload is not sent, since its bytes are there already."""
    first = relief_file("float.ply")
    jobs = []
    for name in ("front.ply", "back.ply"):
        mesh = client.upload(first.rename(first.with_name(name)))
        first = first.with_name(name)
        jobs.append(client.create_job(spec(mesh.id, method=SMOOTH)))
    assert [client.wait(job.id, timeout_s=120).mesh_name for job in jobs] == ["front.ply", "back.ply"]


def test_a_dictionary_without_a_name_is_pinned_to_the_one_that_ships(
    client: Client, relief_file: Callable[[str], Path]
) -> None:
    asked = spec(client.upload(relief_file("float.ply")).id, method={"method": "dictionary"})
    job = client.wait(client.create_job(asked).id, timeout_s=GUARD_S)
    shipped = shipped_model("general-dictionary@1").read_bytes()
    assert (job.model.requested, job.model.name, job.model.version) == ("default", "general-dictionary", 1)
    assert job.model.sha256 == hashlib.sha256(shipped).hexdigest()


def test_a_picture_is_drawn_on_request_only(client: Client, relief_file: Callable[[str], Path]) -> None:
    mesh = client.upload(relief_file("float.ply"))
    job = client.create_job(spec(mesh.id, method=SMOOTH))
    assert client.wait(job.id, timeout_s=GUARD_S).links.preview is None


def test_the_hole_list_of_a_mesh_agrees_with_what_a_repair_finds(
    client: Client, relief_file: Callable[[str], Path]
) -> None:
    mesh = client.wait_for_mesh(client.upload(relief_file("float.ply")).id, timeout_s=GUARD_S)
    plan = client.plan(spec(mesh.id, method=SMOOTH, holes={"ids": [2, 3]}))
    job = client.wait(client.create_job(spec(mesh.id, method=SMOOTH, holes={"ids": [2, 3]})).id, timeout_s=GUARD_S)
    assert mesh.state == MeshState.READY
    assert mesh.facts is not None
    assert [hole.edges for hole in mesh.facts.holes] == sorted((h.edges for h in mesh.facts.holes), reverse=True)
    assert [hole.id for hole in plan.holes if hole.selected] == [2, 3]
    assert job.result is not None
    assert job.result.holes.filled_smooth == plan.selected


def test_every_format_comes_back_as_another_one_when_asked(
    client: Client, relief_file: Callable[[str], Path], tmp_path: Path
) -> None:
    mesh = client.upload(relief_file("float.ply"))
    job = client.wait(
        client.create_job(spec(mesh.id, method=SMOOTH, output={"format": "stl", "preview": False})).id,
        timeout_s=GUARD_S,
    )
    client.download(job, "result", tmp_path / "repaired.stl")
    assert read_scan(tmp_path / "repaired.stl").format == "stl"


def test_one_idempotency_key_starts_one_job(client: Client, relief_file: Callable[[str], Path]) -> None:
    mesh = client.upload(relief_file("float.ply"))
    key = f"test-{mesh.id[:8]}-once"
    first = client.create_job(spec(mesh.id, method=SMOOTH), key)
    assert client.create_job(spec(mesh.id, method=SMOOTH), key).id == first.id
    client.wait(first.id, timeout_s=GUARD_S)


def test_the_same_job_twice_gives_the_same_bytes(client: Client, relief_file: Callable[[str], Path]) -> None:
    mesh = client.upload(relief_file("float.ply"))
    jobs = [client.create_job(spec(mesh.id, method=SELF)) for _ in range(2)]
    hashes = set()
    for job in jobs:
        result = client.wait(job.id, timeout_s=GUARD_S).result
        assert result is not None
        hashes.add(result.files[0].sha256)
    assert len(hashes) == 1
