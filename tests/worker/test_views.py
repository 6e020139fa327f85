"""A worker makes views: of meshes, of repairs, of models; each once."""

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from jobkit.database.session import Database
from jobkit.jobs.jobs import Jobs
from jobkit.meshes import Meshes
from jobkit.models.shipped import seed_shipped
from jobkit.retention import delete_mesh
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from jobkit.views import FAILED, MADE, MAKING, View, ViewOrder
from quadpatch_client.schema import Job
from service.services import shipped_models_folder
from tests.integration.conftest import ply_bytes, punched_relief
from tests.quadpatch.views.test_glb import attribute, extras, loaded
from tests.worker.test_repairs import new_job, working
from worker.context import Context
from worker.jobs import make_view, run_job


@pytest.fixture
def context(settings: Settings, database: Database, store: ObjectStore) -> Iterator[Context]:
    with working(settings, database, store) as context:
        yield context


def uploaded(context: Context, data: bytes, name: str = "scan.ply") -> str:
    with context.store.writer("meshes") as writer:
        writer.write(data)
        stored = writer.commit()
    return Meshes(context.database).add(stored, name, None)[0].id


def made(context: Context, order: ViewOrder) -> View:
    make_view(context.views.order(order).id)
    return context.views.order(order)


def content(context: Context, view: View) -> bytes:
    assert view.stored is not None, view.problem
    return b"".join(context.store.read(view.stored.key))


def repaired(context: Context) -> Job:
    job = new_job(context)
    run_job(job.id)
    return Jobs(context.database).get(job.id)


def test_a_mesh_is_shown_before_its_analysis(context: Context) -> None:
    mesh_id = uploaded(context, ply_bytes(*punched_relief(20, 1)))
    view = made(context, ViewOrder("mesh", mesh_id=mesh_id, level="coarse"))
    file = loaded(content(context, view))
    assert extras(file)["level"] == "coarse"
    assert len(attribute(file, 0, "POSITION")) > 300
    assert view.stored is not None
    assert view.stored.key.startswith("views/")


def test_outlines_have_the_rims_of_the_holes(context: Context) -> None:
    mesh_id = uploaded(context, ply_bytes(*punched_relief(20, 1)))
    outlines = json.loads(content(context, made(context, ViewOrder("outlines", mesh_id=mesh_id))))
    assert [hole["id"] for hole in outlines["holes"]] == list(range(outlines["n_holes"]))
    assert len(outlines["holes"]) == 2


def test_a_repair_is_shown_with_its_invented_surface_and_distances(context: Context) -> None:
    job = repaired(context)
    reference = uploaded(context, ply_bytes(*punched_relief(24, 1)), "cad.ply")
    order = ViewOrder("job", mesh_id=job.mesh_id, job_id=job.id, reference_id=reference, level="fine")
    file = loaded(content(context, made(context, order)))
    assert [node["name"] for node in file.document["nodes"]] == ["measured", "invented"]
    assert (attribute(file, 1, "_CONFIDENCE") > 0).all()
    for part in (0, 1):
        assert np.isfinite(attribute(file, part, "_DISTANCE_TO_REFERENCE")).all()


def test_a_model_is_drawn(context: Context, tmp_path: Path) -> None:
    seed_shipped(context.registry, shipped_models_folder())
    order = ViewOrder("model", model_name="general-dictionary", model_version=1)
    (tmp_path / "picture.png").write_bytes(content(context, made(context, order)))
    with Image.open(tmp_path / "picture.png") as picture:
        assert picture.width > 600


def test_what_is_no_mesh_is_refused_with_the_reason(context: Context) -> None:
    view = made(context, ViewOrder("mesh", mesh_id=uploaded(context, b"no mesh"), level="coarse"))
    assert view.state == FAILED
    assert view.problem is not None
    assert view.problem.startswith("unreadable_mesh: ")


def test_a_mesh_whose_bytes_are_gone_has_no_view(context: Context) -> None:
    mesh_id = uploaded(context, b"ply")
    context.store.delete(Meshes(context.database).source(mesh_id).key)
    view = made(context, ViewOrder("mesh", mesh_id=mesh_id, level="coarse"))
    assert view.problem == "mesh_missing: the source is gone from the store"


def test_a_result_whose_bytes_changed_has_no_view(context: Context) -> None:
    job = repaired(context)
    _, keys = context.jobs.with_files(job.id)
    context.store.delete(keys["report.json"])
    with context.store.writer("results") as writer:
        writer.write(b"{}")
        writer.commit(keys["report.json"])
    view = made(context, ViewOrder("job", mesh_id=job.mesh_id, job_id=job.id, level="coarse"))
    assert view.problem is not None
    assert view.problem.startswith("object_damaged: ")


def test_a_view_is_made_once_and_of_what_is_gone_never(context: Context) -> None:
    mesh_id = uploaded(context, ply_bytes(*punched_relief(20, 1)))
    view = made(context, ViewOrder("mesh", mesh_id=mesh_id, level="coarse"))
    make_view(view.id)
    assert context.views.order(ViewOrder("mesh", mesh_id=mesh_id, level="coarse")).attempt == 1
    waiting = context.views.order(ViewOrder("mesh", mesh_id=mesh_id, level="fine"))
    delete_mesh(context.database, mesh_id)
    make_view(waiting.id)
    assert context.views.unfinished([view.id, waiting.id]) == set()


def test_a_worker_that_is_asked_to_stop_hands_a_view_back_uncounted(context: Context) -> None:
    mesh_id = uploaded(context, ply_bytes(*punched_relief(20, 1)))
    context.draining.set()
    view = made(context, ViewOrder("mesh", mesh_id=mesh_id, level="coarse"))
    assert view.state == MAKING
    context.draining.clear()
    make_view(view.id)
    assert context.views.order(ViewOrder("mesh", mesh_id=mesh_id, level="coarse")).state == MADE
