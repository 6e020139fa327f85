"""Also tests `worker.result_facts`."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from jobkit.errors import ObjectNotFoundError, StoreUnavailableError
from jobkit.jobs.endings import Attempt
from jobkit.storage.base import ObjectStore, StoredObject, result_key
from worker.engine.limits import EngineLimits
from worker.engine.request import EngineRequest
from worker.failures import Failure
from worker.result_facts import facts_of_task
from worker.results import Cost, drop_result, missing_pictures, note_deprecation, note_lost_pictures, store_result

ATTEMPT = Attempt("job_01jd7z3v5qk8m2x4c6b8n0a9de", 2)
REQUEST = EngineRequest("repair", "mesh/source.stl", EngineLimits(60.0, 1024), output="repaired.stl")
COST = Cost(1.5, 312)


PICTURES = (
    ("preview", "preview.png", "there is no picture"),
    ("closeups", "closeups.zip", "there are no close-ups"),
    ("html_report", "report.html", "there is no HTML report"),
)


class RefusesPictures:
    """A store that takes everything but pictures."""

    def __init__(self, store: ObjectStore, error: Exception) -> None:
        self._store = store
        self._error = error

    def __getattr__(self, name: str) -> Any:
        return getattr(self._store, name)

    def put_file(self, key: str, path: Path) -> StoredObject:
        if key.endswith((".png", ".zip", ".html")):
            raise self._error
        return self._store.put_file(key, path)


def finished_folder(folder: Path, **report: Any) -> Path:
    """What an engine leaves that has filled one hole of two."""
    whole = {
        "counts": {"found": 2, "filled": 1, "filled_smooth": 0, "skipped": 1, "refused": 0},
        "holes": [{"new_vertices": 3, "new_triangles": 8}, {"new_vertices": 0, "new_triangles": 0}],
        "warnings": [],
        **report,
    }
    (folder / "report.json").write_text(json.dumps(whole))
    (folder / "repaired.stl").write_bytes(b"stl")
    return folder


def test_files_lie_where_only_this_attempt_writes(tmp_path: Path, store: ObjectStore) -> None:
    (tmp_path / "preview.png").write_bytes(b"png")
    (tmp_path / "closeups.zip").write_bytes(b"zip")
    (tmp_path / "report.html").write_bytes(b"<!DOCTYPE html>")
    result = store_result(finished_folder(tmp_path), REQUEST, ATTEMPT, store, COST)
    assert [(file.role, file.name, file.media_type) for file in result.files] == [
        ("result", "repaired.stl", "model/stl"),
        ("report", "report.json", "application/json"),
        ("preview", "preview.png", "image/png"),
        ("closeups", "closeups.zip", "application/zip"),
        ("html_report", "report.html", "text/html"),
    ]
    for file in result.files:
        assert store.size(result_key(ATTEMPT.job_id, 2, file.name)) == file.size_bytes
    assert (result.format, result.new_vertices, result.new_triangles) == ("stl", 3, 8)
    assert (result.seconds, result.peak_memory_mb) == (1.5, 312)
    assert result.warnings == []


def test_the_result_of_a_task_tells_what_it_counted_and_nothing_of_holes(tmp_path: Path, store: ObjectStore) -> None:
    error = {"promised": 0.3, "true_to_decoded": 0.2, "decoded_to_true": 0.25}
    report = {"task": "encode", "max_error": error, "warnings": ["folded"], "counts": {"found": 9}}
    (tmp_path / "report.json").write_text(json.dumps(report))
    (tmp_path / "encoded.qpz").write_bytes(b"qpz")
    request = replace(REQUEST, task="encode", output="encoded.qpz")
    result = store_result(tmp_path, request, ATTEMPT, store, COST)
    assert [(file.role, file.name) for file in result.files] == [("result", "encoded.qpz"), ("report", "report.json")]
    assert (result.format, result.max_error, result.moved_vertices, result.warnings) == ("qpz", 0.25, None, ["folded"])
    assert result.holes.found == 0


def test_the_numbers_of_a_report_are_those_of_the_result() -> None:
    restored = facts_of_task({"vertices": {"missing": 9, "restored": 7, "left": 2}, "warnings": ["2 are left"]})
    assert (restored["restored_vertices"], restored["moved_vertices"], restored["warnings"]) == (
        7,
        None,
        ["2 are left"],
    )
    denoised = facts_of_task({"moved_vertices": 5, "shift_95": 0.5, "warnings": []})
    assert (denoised["moved_vertices"], denoised["shift_95"], denoised["max_error"]) == (5, 0.5, None)
    assert facts_of_task({"max_error": 0.25, "warnings": []})["max_error"] == 0.25


def test_a_result_without_a_picture_has_two_files(tmp_path: Path, store: ObjectStore) -> None:
    result = store_result(finished_folder(tmp_path), REQUEST, ATTEMPT, store, COST)
    assert [file.role for file in result.files] == ["result", "report"]


@pytest.mark.parametrize(
    ("report", "warnings"),
    [
        ({"warnings": ["the scan is coarse"]}, ["the scan is coarse"]),
        ({"counts": {"found": 1, "refused": 1}}, ["1 hole was refused and left open; the report says why"]),
        ({"counts": {"found": 3, "refused": 3}}, ["3 holes were refused and left open; the report says why"]),
        ({"counts": {"found": 1, "refused": 1}, "warnings": ["hole 0 is refused"]}, ["hole 0 is refused"]),
    ],
)
def test_refused_holes_are_a_warning(
    tmp_path: Path, store: ObjectStore, report: dict[str, Any], warnings: list[str]
) -> None:
    assert store_result(finished_folder(tmp_path, **report), REQUEST, ATTEMPT, store, COST).warnings == warnings


def test_warnings_of_a_result_have_their_codes(tmp_path: Path, store: ObjectStore) -> None:
    folder = finished_folder(tmp_path, counts={"found": 2, "refused": 2})
    note_deprecation(folder, "plaster@3", "a better one is there")
    result = store_result(folder, REQUEST, ATTEMPT, store, COST)
    (detail,) = result.warning_details
    assert (detail.code, detail.message) == ("deprecated_model_for", result.warnings[0])
    assert detail.values == {"model": "plaster@3", "reason": "a better one is there"}


@pytest.mark.parametrize("error", [StoreUnavailableError("away"), OSError(5, "I/O error")])
@pytest.mark.parametrize(("_", "name", "words"), PICTURES)
def test_a_picture_that_can_not_be_stored_is_a_warning(
    tmp_path: Path, store: ObjectStore, error: Exception, _: str, name: str, words: str
) -> None:
    (tmp_path / name).write_bytes(b"picture")
    result = store_result(finished_folder(tmp_path), REQUEST, ATTEMPT, RefusesPictures(store, error), COST)
    assert [file.role for file in result.files] == ["result", "report"]
    assert result.warnings == [f"{words}: the store failed"]
    report = json.loads(b"".join(store.read(result_key(ATTEMPT.job_id, 2, "report.json"))))
    assert report["warnings"] == result.warnings


@pytest.mark.parametrize(("role", "name", "words"), PICTURES)
def test_pictures_that_were_drawn_are_kept_and_the_missing_one_is_named_in_the_report(
    tmp_path: Path, store: ObjectStore, role: str, name: str, words: str
) -> None:
    request = replace(REQUEST, with_preview=True, with_close_ups=True, html_report={})
    for _, other, _ in PICTURES:
        if other != name:
            (tmp_path / other).write_bytes(b"picture")
    folder = finished_folder(tmp_path, warnings=["the scan is coarse"])
    assert [picture.role for picture in missing_pictures(folder, request)] == [role]
    note_lost_pictures(folder, request, Failure("out_of_memory", "the work needs more memory than 512 MiB"))
    result = store_result(folder, request, ATTEMPT, store, COST)
    assert len(result.files) == 4
    assert result.file(role) is None
    assert result.warnings == ["the scan is coarse", f"{words}: the work needs more memory than 512 MiB"]


def test_a_picture_of_which_the_engine_said_why_it_is_missing_gets_one_warning(tmp_path: Path) -> None:
    said = "there is no picture: there is no surface to draw"
    folder = finished_folder(tmp_path, warnings=[said], stages=[{"name": "preview", "seconds": 0.1}])
    note_lost_pictures(folder, replace(REQUEST, with_preview=True), Failure("crashed", "the engine was ended"))
    assert json.loads((folder / "report.json").read_text())["warnings"] == [said]


def test_a_dropped_result_leaves_that_of_another_attempt_alone(tmp_path: Path, store: ObjectStore) -> None:
    for number in (2, 3):
        store_result(finished_folder(tmp_path), REQUEST, Attempt(ATTEMPT.job_id, number), store, COST)
    drop_result(ATTEMPT, store)
    with pytest.raises(ObjectNotFoundError):
        store.size(result_key(ATTEMPT.job_id, 2, "repaired.stl"))
    assert store.size(result_key(ATTEMPT.job_id, 3, "repaired.stl")) == 3
