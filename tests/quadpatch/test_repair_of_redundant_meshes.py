"""Files that hold faces twice, fins, faces turned over, or vertices torn apart by rounding: from file to file."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from quadpatch.formats.reading import read_scan
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.options import RepairOptions
from quadpatch.repair import inspect_file, repair_file
from quadpatch.types import IntArray, TriangleMesh, Triangles
from tests.quadpatch.shapes import faces_per_edge, joined, punched, sphere, write_ply
from tests.quadpatch.test_repair import write_stl

BALL = punched(sphere(3), (0, 0, 1), radius=0.3)
N = len(BALL.triangles)
(RIM,) = boundary_loops(BALL.triangles).loops
CASES = Path(__file__).parents[2].parent / "shared" / "cases"
needs_cases = pytest.mark.skipif(not CASES.is_dir(), reason="the shared cases are not here")


def with_faces(*rows: Triangles) -> TriangleMesh:
    return TriangleMesh(BALL.vertices, np.concatenate([BALL.triangles, *rows]))


def with_one_turned() -> TriangleMesh:
    faces = BALL.triangles.copy()
    at_rim = np.flatnonzero(np.isin(faces, RIM).sum(axis=1) == 2)[0]
    faces[at_rim] = faces[at_rim, ::-1]
    return TriangleMesh(BALL.vertices, faces)


def with_fin() -> TriangleMesh:
    first = BALL.triangles[np.isin(BALL.triangles, RIM).sum(axis=1) == 1][0]
    start, end = (np.roll(first, -k)[:2] for k in range(3) if np.roll(first, -k)[0] in RIM).__next__()
    tip = 1.2 * BALL.vertices[[start, end]].mean(axis=0)
    mesh = with_faces(np.array([[start, end, len(BALL.vertices)]]))
    return TriangleMesh(np.concatenate([BALL.vertices, [tip]]), mesh.triangles)


KINDS: dict[str, tuple[TriangleMesh, str, str]] = {
    "one face twice": (with_faces(BALL.triangles[:1]), "duplicate_triangles", "1 faces are exact copies"),
    "all faces twice": (with_faces(BALL.triangles), "duplicate_triangles", "the surface is doubled"),
    "two shells": (
        joined(BALL, TriangleMesh(BALL.vertices, BALL.triangles[:, ::-1])),
        "duplicate_triangles",
        "the surface is doubled",
    ),
    "a fin": (with_fin(), "fin_triangles", "ignored as fins"),
    "a face turned over": (with_one_turned(), "turned_triangles", "turned over"),
}


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize("suffix", [".ply", ".stl"])
def test_its_hole_is_filled_all_is_kept_and_the_report_says_so(tmp_path: Path, name: str, suffix: str) -> None:
    mesh, count, words = KINDS[name]
    source, output = tmp_path / f"in{suffix}", tmp_path / f"out{suffix}"
    write_ply(source, mesh) if suffix == ".ply" else write_stl(source, mesh)
    report = repair_file(source, output, "smooth")
    assert report["counts"]["filled_smooth"] == report["counts"]["found"] == 1
    assert report["welded"][count] > 0
    assert [words in warning for warning in report["warnings"]] == [True]
    before, after = read_scan(source), read_scan(output)
    assert after.vertices[: len(before.vertices)].tobytes() == before.vertices.tobytes()
    assert after.triangles[: len(before.triangles)].tobytes() == before.triangles.tobytes()
    facts = inspect_file(source)
    assert (facts["warnings"], facts["welded"]) == (report["warnings"], report["welded"])
    assert inspect_file(output)["holes"] == []
    # The fill faces outwards, as the surface around it does.
    new = after.vertices[after.triangles[len(before.triangles) :]]
    assert (np.einsum("ij,ij->i", np.cross(new[:, 1] - new[:, 0], new[:, 2] - new[:, 0]), new[:, 0]) > 0).all()


def test_a_hole_in_a_part_that_is_turned_over_is_filled_as_that_part_faces(tmp_path: Path) -> None:
    mesh = punched(sphere(3), (0, 0, 1), (0, 0, -1), radius=0.3)
    faces = mesh.triangles.copy()
    near = mesh.vertices[faces].mean(axis=1)[:, 2] > 0.8
    faces[near] = faces[near, ::-1]
    source, output = write_ply(tmp_path / "in.ply", TriangleMesh(mesh.vertices, faces)), tmp_path / "out.ply"
    report = repair_file(source, output, "smooth")
    assert report["counts"]["filled_smooth"] == 2
    new = read_scan(output)
    triangles = new.vertices[new.triangles[len(faces) :]]
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    outwards = np.einsum("ij,ij->i", normals, triangles[:, 0]) > 0
    assert (outwards == (triangles[:, 0, 2] < 0)).all()


def test_noise_is_joined_by_default_and_left_on_demand(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    corners = BALL.vertices[BALL.triangles].reshape(-1, 3).astype(np.float32)
    noisy = np.nextafter(corners, rng.choice(np.array([-9, 9], np.float32), corners.shape))
    torn = np.where(rng.random(corners.shape) < 0.02, noisy, corners).astype(np.float64)
    mesh = TriangleMesh(torn, np.arange(len(corners)).reshape(-1, 3))
    source, output = write_stl(tmp_path / "in.stl", mesh), tmp_path / "out.stl"
    report = repair_file(source, output, "smooth")
    assert report["counts"]["filled_smooth"] == report["counts"]["found"] == 1
    assert report["welded"]["near_vertices"] > 0
    assert 0 < report["welded"]["tolerance"] < 1e-5
    assert len(inspect_file(source)["holes"]) == 1
    exact = inspect_file(source, 0.0)
    assert len(exact["holes"]) > 1
    found = repair_file(source, output, "smooth", RepairOptions(weld_tolerance=0.0))
    assert [hole["id"] for hole in found["holes"]] == [hole["id"] for hole in exact["holes"]]


@needs_cases
@pytest.mark.parametrize(
    ("name", "n_holes", "words"),
    [
        ("doubled_face_at_rim.ply", 1, "3 faces are exact copies"),
        ("doubled_surface.ply", 1, "5,008 of 10,016 faces are exact copies of others: the surface is doubled"),
        ("last_bit_noise.stl", 1, ""),
    ],
)
def test_the_shared_cases_show_their_one_hole(name: str, n_holes: int, words: str) -> None:
    facts = inspect_file(CASES / name)
    assert [hole["is_manifold"] for hole in facts["holes"]] == [True] * n_holes
    assert words in "".join(facts["warnings"])


@pytest.mark.parametrize("suffix", [".ply", ".glb", ".3mf", ".obj", ".off", ".stl"])
def test_a_second_repair_goes_on_counting(tmp_path: Path, suffix: str) -> None:
    mesh = punched(sphere(3), (0, 0, 1), (0, 1, 0), radius=0.3)
    source, once = write_ply(tmp_path / "in.ply", mesh), tmp_path / f"once{suffix}"
    first = _numbers(repair_file(source, once, "smooth"))
    is_numbered = suffix in (".ply", ".glb", ".3mf")
    assert first == ([0, 1] if is_numbered else [None, None])
    # Cut again: the marked file itself, where it can lose faces in place; a hole far from the others.
    if suffix != ".ply":
        again = repair_file(once, tmp_path / f"twice{suffix}", "smooth")
        assert again["counts"]["found"] == 0
        assert read_scan(once).next_hole_id == (2 if is_numbered else 0)
        return
    cut = _without_a_cap(once, tmp_path / "cut.ply")
    twice = tmp_path / "twice.ply"
    assert _numbers(repair_file(cut, twice, "smooth")) == [2]
    old, new = _marks(cut), _marks(twice)
    assert (new[: len(old)] == old).all()
    assert set(new[len(old) :].tolist()) == {2}
    assert (faces_per_edge(read_scan(twice).triangles) == 2).all()
    assert read_scan(twice).next_hole_id == 3


def _numbers(report: dict[str, Any]) -> list[int | None]:
    return [hole["hole_id"] for hole in report["holes"] if hole["new_triangles"]]


def _without_a_cap(path: Path, output: Path) -> Path:
    """Take the faces of a binary PLY around the lowest point away."""
    scan = read_scan(path)
    gone = np.asarray((scan.vertices[scan.triangles][:, :, 2] < -0.98).any(axis=1))
    data = path.read_bytes()
    size = 13 + 9
    faces = np.frombuffer(data[-size * len(gone) :], np.uint8).reshape(len(gone), size)[~gone]
    head = data[: -size * len(gone)].replace(b"element face %d" % len(gone), b"element face %d" % len(faces))
    output.write_bytes(head + faces.tobytes())
    return output


def _marks(path: Path) -> IntArray:
    """Numbers of holes of all faces of a binary PLY."""
    data = path.read_bytes()
    size, n = 13 + 9, len(read_scan(path).triangles)
    return np.frombuffer(data[-size * n :], np.dtype([("old", "V14"), ("hole", "<i4"), ("confidence", "<f4")]))["hole"]
