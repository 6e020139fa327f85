from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from quadpatch.types import TriangleMesh
from tests.training.test_main import write_ply
from training.build_corpus import CorpusOptions, build_corpus, cut_heights
from training.patterns import PATTERNS
from training.procedural import relief_mesh
from training.sources import find_sources

OPTIONS = CorpusOptions(resolution=12, edges=8.0, scales=(1.0, 1.5), overlap=0, places=40)


@pytest.fixture(scope="module")
def relief() -> TriangleMesh:
    return relief_mesh("waves", np.random.default_rng(0), 50)


def test_heights_do_not_change_with_the_unit_of_length(relief: TriangleMesh) -> None:
    cut = cut_heights(relief, OPTIONS, np.random.default_rng(0))
    heights, known = cut["heights"].astype(np.float64), cut["known"]
    assert cut["heights"].dtype == np.float32
    assert 20 < len(heights) <= 80
    assert (heights[~known] == 0.0).all()
    larger = cut_heights(TriangleMesh(1024.0 * relief.vertices, relief.triangles), OPTIONS, np.random.default_rng(0))
    np.testing.assert_array_equal(larger["known"], known)
    np.testing.assert_allclose(larger["heights"], heights, atol=1e-5)


def test_a_corpus_of_normalised_meshes_is_the_same_for_every_unit(relief: TriangleMesh, tmp_path: Path) -> None:
    counts = []
    for name, scale in (("one", 1.0), ("other", 1024.0)):
        write_ply(tmp_path / f"{name}.ply", TriangleMesh(scale * relief.vertices, relief.triangles))
        options = replace(OPTIONS, edge_length=0.03)
        corpus = build_corpus(find_sources([tmp_path / f"{name}.ply"]), [], options, tmp_path / name)
        counts.append(corpus.meshes("train")[0]["count"])
    assert counts[0] == counts[1] > 0


def test_a_mesh_too_small_for_a_patch_gives_none(relief: TriangleMesh) -> None:
    cut = cut_heights(relief, CorpusOptions(resolution=12, edges=500.0), np.random.default_rng(0))
    assert cut["heights"].shape == cut["known"].shape == (0, 12, 12)


def test_a_corpus_is_split_by_mesh_and_repeats_byte_for_byte(relief: TriangleMesh, tmp_path: Path) -> None:
    meshes = tmp_path / "meshes"
    meshes.mkdir()
    for name in ("a", "b"):
        write_ply(meshes / f"{name}.ply", relief)
    one, other = find_sources([meshes])
    heard: list[tuple[str, float]] = []
    corpora = [
        build_corpus([one], [other], OPTIONS, tmp_path / folder, lambda name, share: heard.append((name, share)))
        for folder in ("first", "second")
    ]
    assert corpora[0].sha256 == corpora[1].sha256
    assert [mesh["name"] for mesh in corpora[0].meshes("train")] == ["a"]
    assert [mesh["name"] for mesh in corpora[0].meshes("validation")] == ["b"]
    assert corpora[0].facts["resolution"] == 12
    assert heard == 2 * [("a", 0.0), ("b", 0.5), ("", 1.0)]


def test_procedural_reliefs_train_and_others_of_them_validate(tmp_path: Path) -> None:
    options = CorpusOptions(
        resolution=8, edges=6.0, scales=(1.0,), overlap=0, places=5, n_procedural=2, relief_side=20, seed=3
    )
    corpus = build_corpus([], [], options, tmp_path)
    train, validation = corpus.meshes("train"), corpus.meshes("validation")
    names = [f"procedural_{pattern}" for pattern in sorted(PATTERNS)]
    assert [mesh["name"] for mesh in train] == [mesh["name"] for mesh in validation] == names
    assert not {mesh["sha256"] for mesh in train} & {mesh["sha256"] for mesh in validation}
    assert train[0]["origin"] == "2 procedural, seed 3"
    assert all(0 < mesh["count"] <= 10 for mesh in train)
