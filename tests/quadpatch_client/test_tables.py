import io
import json

from rich.console import Console

from quadpatch_client.schema import Job, MeshFacts, ModelList, Plan
from quadpatch_client.tables import print_holes, print_jobs, print_models
from tests.quadpatch_client.wire_jobs import JOB_ID, body

HOLE = {
    **{"perimeter": 9.0, "diameter": 3.0, "area": 7.0, "planarity": 0.01, "edges": 12, "is_manifold": True},
    **{"kind": "hole", "centre": [1.0, 2.5, -3.0]},
}
FACTS = MeshFacts.model_validate(
    {
        **{"format": "ply", "unit": None, "vertices": 1000, "triangles": 1998, "holes": []},
        **{"bounding_box": {"min": [0.0] * 3, "max": [1.0] * 3}, "diagonal": 1.7, "mean_edge_length": 0.1},
    }
)


def printed() -> tuple[Console, io.StringIO]:
    text = io.StringIO()
    return Console(file=text, width=200), text


def test_every_hole_says_whether_it_would_be_filled_and_why_not() -> None:
    holes = [
        {**HOLE, "id": 0, "selected": True, "action": "model"},
        {**HOLE, "id": 1, "selected": False, "reason": "too_wide"},
        {**HOLE, "id": 2, "selected": False, "joined_to": 0},
        {**HOLE, "id": 3, "selected": True, "action": "model", "bridged_to": 4},
    ]
    bridges = [
        {"holes": [3, 4], "selected": True, "is_proposed": False},
        {"holes": [0, 1], "selected": False, "is_proposed": True, "shape": "ring", "gap": 0.25, "share": 0.9},
    ]
    model = {"requested": "smooth", "kind": "none"}
    limits = {"time_s": 60, "memory_mb": 1024}
    values = {"holes": holes, "bridges": bridges, "selected": 1, "limits": limits}
    plan = Plan.model_validate({"mesh_id": "0" * 64, "model": model, **values})
    console, text = printed()
    print_holes(console, FACTS, plan)
    lines = [line.rstrip() for line in text.getvalue().splitlines()]
    assert lines[0] == "1,000 vertices, 1,998 triangles, 4 holes; lengths in mesh units"
    assert [line.split("hole  ")[1].split("  ")[-1] for line in lines[2:6]] == [
        "yes: model",
        "no: too wide",
        "yes: joined to hole 0",
        "yes: bridge to loop 4",
    ]
    assert all("1 2.5 -3" in line for line in lines[2:6])
    assert lines[6:] == [
        "1 of 4 would be filled",
        "loops 3 and 4: they would be joined",
        "loops 0 and 1 face each other, 0.25 mesh units apart: not joined; --bridge 0:1 joins them",
    ]


def test_a_job_shows_its_error_or_else_its_stage() -> None:
    error = {"code": "no_quads", "message": "the outline is too small"}
    jobs = [
        Job.model_validate_json(body("running", 2, stage="fill", percent=42.4)),
        Job.model_validate(json.loads(body("failed", 3)) | {"error": error}),
    ]
    console, text = printed()
    print_jobs(console, jobs)
    _, running, failed = text.getvalue().splitlines()
    assert running.split()[:5] == [JOB_ID, "running:", "fill", "42", "%"]
    assert failed.split()[:3] == [JOB_ID, "failed:", "no_quads"]
    assert "11-22 09:15 " in running


def test_jobs_fit_80_columns_with_their_whole_ids_states_and_labels() -> None:
    job = json.loads(body("succeeded_with_warnings", 3)) | {
        "spec": {"mesh_id": "0" * 64, "label": "station 4, part 1187"}
    }
    text = io.StringIO()
    print_jobs(Console(file=text, width=80), [Job.model_validate(job)])
    _, first, second = text.getvalue().splitlines()
    assert first.split() == [JOB_ID, "succeeded_with_warnings", "11-22", "09:15", "station", "4,"]
    assert second.split() == ["part", "1187"]


def test_empty_lists_are_said_to_be_empty() -> None:
    console, text = printed()
    print_jobs(console, [])
    print_models(console, ModelList(models=[], aliases=[]))
    assert text.getvalue().splitlines() == ["no jobs", "no models"]
