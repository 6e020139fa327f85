import json
from pathlib import Path

import numpy as np
import pytest

from quadpatch.errors import EmptyMeshError, OptionError
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.measures import longest_side, mean_edge_length
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import moved, sphere, write_ply
from training.corpus import read_mesh
from training.normalise import normalise_dataset, normalised, read_normalised
from training.sources import find_sources


@pytest.mark.parametrize(("fineness", "edge"), [(5, 0.08), (2, 0.04)])
def test_fine_and_coarse_meshes_come_to_one_size_and_edge_length(fineness: int, edge: float) -> None:
    mesh = moved(sphere(fineness, 7.0), (100.0, -20.0, 3.0))
    made = normalised(mesh, edge)
    assert abs(longest_side(made) - 1) < 0.01
    assert abs(mean_edge_length(made) / edge - 1) < 0.3
    unit = TriangleMesh((mesh.vertices - mesh.vertices.min(axis=0)) / longest_side(mesh), mesh.triangles)
    assert distance_to_mesh(made.vertices, unit).max() < 0.02


def test_a_mesh_with_an_edge_of_three_faces_is_cut_there() -> None:
    ball = sphere(2)
    a, b = ball.triangles[0][:2]
    vertices = np.concatenate([ball.vertices, [1.5 * ball.vertices[a]]])
    fin = TriangleMesh(vertices, np.concatenate([ball.triangles, [[a, b, len(ball.vertices)]]]))
    assert mean_edge_length(normalised(fin, 0.05)) < 0.07


def test_a_mesh_without_extent_is_an_error() -> None:
    with pytest.raises(EmptyMeshError):
        normalised(TriangleMesh(np.zeros((3, 3)), np.array([[0, 1, 2]])), 0.1)


def test_training_normalises_on_demand_as_the_command_does(tmp_path: Path) -> None:
    write_ply(tmp_path / "ball.ply", sphere(3, 5.0))
    write_ply(tmp_path / "half.ply", sphere(3, 2.5))
    (made,) = normalise_dataset(find_sources([tmp_path / "ball.ply"]), 0.1, tmp_path / "unit")
    on_demand, half = (read_normalised(tmp_path / f"{name}.ply", 0.1) for name in ("ball", "half"))
    assert np.abs(on_demand.vertices - read_mesh(made).vertices).max() < 1e-6
    assert abs(longest_side(half) - longest_side(on_demand)) < 1e-6
    assert longest_side(read_normalised(tmp_path / "half.ply", None)) == pytest.approx(5.0, rel=0.01)


def test_a_dataset_keeps_its_names_and_licences(tmp_path: Path) -> None:
    meshes = tmp_path / "meshes"
    meshes.mkdir()
    write_ply(meshes / "ball.ply", sphere(3, 5.0))
    write_ply(meshes / "egg.ply", TriangleMesh(sphere(3).vertices * [1.0, 1.0, 2.0], sphere(3).triangles))
    manifest = [{"name": "ball", "licence": "CC0", "source_repo": "museum", "source_path": "ball.obj"}]
    (meshes / "manifest.json").write_text(json.dumps(manifest))
    written = normalise_dataset(find_sources([meshes]), 0.1, tmp_path / "unit")
    assert [path.name for path in written] == ["ball.ply", "egg.ply"]
    for path in written:
        assert abs(longest_side(read_mesh(path)) - 1) < 0.02
    ball, _ = find_sources([tmp_path / "unit"])
    assert (ball.licence, ball.origin) == ("CC0", "museum/ball.obj")
    with pytest.raises(OptionError, match="not empty"):
        normalise_dataset(find_sources([meshes]), 0.1, tmp_path / "unit")
