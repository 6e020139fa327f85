"""What stations send, repaired by jobs with the default method: nothing is asked for but what a test is about."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.formats.reading import read_scan
from quadpatch.types import FloatArray
from quadpatch_client.schema import Job, JobSpec, JobState
from quadpatch_client.sdk import Client
from tests.integration.conftest import punched_relief, stl_bytes
from tests.quadpatch.filling.gaps import torn_sphere
from tests.quadpatch.formats.coloured_files import coloured_ply
from tests.quadpatch.shapes import punched, relief
from tests.waiting import GUARD_S


def ended(client: Client, mesh_id: str, **fields: Any) -> Job:
    job = client.create_job(JobSpec.model_validate({"mesh_id": mesh_id, **fields}))
    job = client.wait(job.id, timeout_s=GUARD_S)
    assert job.state == JobState.SUCCEEDED, job.error
    return job


def report_of(client: Client, job: Job, folder: Path) -> dict[str, Any]:
    client.download(job, "report", folder / "report.json")
    report: dict[str, Any] = json.loads((folder / "report.json").read_text())
    return report


def colours_of(path: Path) -> FloatArray:
    scan = read_scan(path)
    assert scan.source is not None
    colours = scan.source.vertex_colours(scan)
    assert colours is not None
    return colours[:, :3]


def test_the_second_repair_of_an_stl_reuses_its_calibration_and_has_the_same_bytes(
    client: Client, tmp_path: Path
) -> None:
    # A scan of its own: the stack of the session keeps the calibrations that other tests asked for.
    scan = tmp_path / "scan.stl"
    scan.write_bytes(stl_bytes(*punched_relief(43, n_holes=3)))
    mesh = client.upload(scan)
    reused, meshes = [], []
    for _ in range(2):
        job = ended(client, mesh.id)
        reused.append(report_of(client, job, tmp_path)["calibration"]["reused"])
        client.download(job, "result", tmp_path / "repaired.stl")
        meshes.append((tmp_path / "repaired.stl").read_bytes())
        assert job.result is not None
        assert job.result.peak_memory_mb
    assert reused == [False, True]
    assert meshes[0] == meshes[1]


def test_a_torn_stl_is_joined_by_the_bridge_that_its_plan_proposes(client: Client, tmp_path: Path) -> None:
    torn = torn_sphere().mesh
    source, output = tmp_path / "torn.stl", tmp_path / "repaired.stl"
    source.write_bytes(stl_bytes(torn.vertices, torn.triangles))
    mesh = client.upload(source)
    client.wait_for_mesh(mesh.id, timeout_s=GUARD_S)
    (proposed,) = client.plan(JobSpec(mesh_id=mesh.id)).bridges
    assert (proposed.is_proposed, proposed.selected) == (True, False)
    job = ended(client, mesh.id, holes={"bridges": [proposed.holes]})
    rows = {row["id"]: row for row in report_of(client, job, tmp_path)["holes"]}
    first, second = (rows[i] for i in proposed.holes)
    assert first["bridge"]["holes"] == second["bridge"]["holes"] == proposed.holes
    assert first["new_triangles"] > 0
    client.download(job, "result", output)
    before, after = read_scan(source), read_scan(output)
    assert np.array_equal(after.triangles[: len(before.triangles)], before.triangles)
    assert len(after.triangles) == len(before.triangles) + first["new_triangles"]


def test_new_vertices_of_a_coloured_ply_get_colours(client: Client, tmp_path: Path) -> None:
    scan = punched(relief(60, 2.0, 0.03, 8), (-0.4, -0.4, 0), (0.4, 0.4, 0), radius=0.2)
    colours = np.random.default_rng(0).integers(60, 200, (len(scan.vertices), 3)).astype(np.float64)
    source, output = tmp_path / "coloured.ply", tmp_path / "repaired.ply"
    source.write_bytes(coloured_ply(scan, colours))
    job = ended(client, client.upload(source).id)
    assert report_of(client, job, tmp_path)["colours"]["method"] in {"exemplars", "harmonic"}
    client.download(job, "result", output)
    before, after = colours_of(source), colours_of(output)
    np.testing.assert_array_equal(after[: len(before)], before)
    new = after[len(before) :]
    assert len(new)
    assert ((new >= 60) & (new < 200)).all()


def test_a_worn_piece_is_repaired_by_what_a_whole_one_shows_and_keeps_its_size(client: Client, tmp_path: Path) -> None:
    whole = relief(100, 2.0, 0.03, 10)
    worn = punched(whole, *[(x, y, 0.0) for x in (-0.5, 0.5) for y in (-0.45, 0.5)], radius=0.1)
    for name, mesh in (("whole", whole), ("worn", worn)):
        (tmp_path / f"{name}.stl").write_bytes(stl_bytes(mesh.vertices, mesh.triangles))
    reference, scan = (client.upload(tmp_path / f"{name}.stl") for name in ("whole", "worn"))
    method = {"method": "dictionary", "model": "self", "learn_from": reference.id}
    job = ended(client, scan.id, method=method, length_unit="millimeter", output={"format": "glb", "preview": False})
    report = report_of(client, job, tmp_path)
    assert report["model"]["learned_from"] == reference.id
    assert report["length_unit"] == "millimeter"
    client.download(job, "result", tmp_path / "repaired.glb")
    assert np.allclose(np.ptp(read_scan(tmp_path / "repaired.glb").vertices, axis=0)[:2], 0.002, rtol=0.01)
