import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.errors import OptionError
from tests.training.patches import patch_arrays, write_corpus
from training.errors import CorpusError
from training.shards import MANIFEST, Corpus, CorpusWriter, PatchSet
from training.sources import Source


@given(sizes=st.lists(st.integers(0, 6), min_size=1, max_size=5), data=st.data())
def test_gathered_patches_are_those_of_all_meshes_joined(sizes: list[int], data: st.DataObject) -> None:
    shards = [patch_arrays(n, 4, seed) for seed, n in enumerate(sizes)]
    joined = {name: np.concatenate([shard[name] for shard in shards]) for name in ("heights", "known")}
    patches = PatchSet(shards)
    assert len(patches) == sum(sizes)
    if len(patches):
        rows = np.array(data.draw(st.lists(st.integers(0, len(patches) - 1), max_size=20)), np.int64)
        gathered = patches.gather(rows)
        for name, array in joined.items():
            assert gathered[name].dtype == array.dtype
            np.testing.assert_array_equal(gathered[name], array[rows])


def test_a_corpus_comes_back_as_it_was_written_and_is_mapped_not_read(tmp_path: Path) -> None:
    written = write_corpus(tmp_path / "corpus")
    corpus = Corpus.open(tmp_path / "corpus")
    assert corpus.sha256 == written.sha256
    assert [mesh["name"] for mesh in corpus.meshes("train")] == ["vase", "relief"]
    assert corpus.meshes("train")[0]["licence"] == "CC BY 4.0"
    train = corpus.patches("train")
    assert len(train) == 45
    assert all(isinstance(array, np.memmap) for shard in train.shards for array in shard.values())
    np.testing.assert_array_equal(train.gather(np.arange(20))["heights"], patch_arrays(20)["heights"])
    corpus.verify()


def test_no_mesh_is_in_both_halves(tmp_path: Path) -> None:
    corpus = write_corpus(tmp_path / "corpus")
    train, validation = ({mesh["sha256"] for mesh in corpus.meshes(split)} for split in ("train", "validation"))
    assert train
    assert validation
    assert not train & validation


def test_meshes_without_a_patch_are_named_but_never_mapped(tmp_path: Path) -> None:
    writer = CorpusWriter(tmp_path, {"recipe": "paper", "resolution": 4})
    writer.add(Source("tiny", Path(), "0" * 64), "train", patch_arrays(0, 4))
    corpus = writer.finish()
    assert [mesh["count"] for mesh in corpus.meshes("train")] == [0]
    assert len(corpus.patches("train")) == 0


def test_the_hash_follows_from_every_byte_and_not_from_the_folder(tmp_path: Path) -> None:
    one, two = write_corpus(tmp_path / "one"), write_corpus(tmp_path / "elsewhere")
    assert one.sha256 == two.sha256
    writer = CorpusWriter(tmp_path / "other", one.facts)
    arrays = patch_arrays(20)
    arrays["heights"][3, 10, 10] += 1e-6
    writer.add(Source("vase", Path(), "0" * 64), "train", arrays)
    other = writer.finish()
    files = [corpus.meshes("train")[0]["files"] for corpus in (one, other)]
    assert files[0]["heights"]["sha256"] != files[1]["heights"]["sha256"]
    assert files[0]["known"] == files[1]["known"]


def test_a_changed_file_is_found(tmp_path: Path) -> None:
    corpus = write_corpus(tmp_path)
    path = tmp_path / corpus.meshes("train")[0]["files"]["heights"]["name"]
    data = bytearray(path.read_bytes())
    data[-1] ^= 1
    path.write_bytes(data)
    with pytest.raises(CorpusError, match="not the file that was written"):
        corpus.verify()
    path.write_bytes(data[: len(data) // 2])
    with pytest.raises(CorpusError, match="can't be mapped"):
        corpus.patches("train")
    np.save(path, np.zeros((3, 24, 24), np.float32))
    with pytest.raises(CorpusError, match="manifest says 20"):
        corpus.patches("train")


def test_a_changed_manifest_is_refused(tmp_path: Path) -> None:
    write_corpus(tmp_path)
    manifest = json.loads((tmp_path / MANIFEST).read_text())
    manifest["meshes"][0]["licence"] = "none"
    (tmp_path / MANIFEST).write_text(json.dumps(manifest))
    with pytest.raises(CorpusError, match="was changed"):
        Corpus.open(tmp_path)


@pytest.mark.parametrize("text", [None, "", "[]", "{}", "\x00"])
def test_a_folder_without_a_manifest_is_no_corpus(tmp_path: Path, text: str | None) -> None:
    if text is not None:
        (tmp_path / MANIFEST).write_text(text)
    with pytest.raises(CorpusError, match="no corpus"):
        Corpus.open(tmp_path)


def test_arrays_are_never_read_from_outside_of_the_folder(tmp_path: Path) -> None:
    writer = CorpusWriter(tmp_path / "corpus", {"recipe": "paper", "resolution": 24})
    writer.add(Source("vase", Path(), "0" * 64), "train", patch_arrays(2))
    np.save(tmp_path / "secret.npy", np.zeros((2, 24, 24), np.float32))
    writer._meshes[0]["files"]["heights"]["name"] = "../secret.npy"
    corpus = writer.finish()
    with pytest.raises(CorpusError, match="can't be mapped"):
        corpus.patches("train")


def test_a_corpus_wants_an_empty_folder(tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("five years of work")
    with pytest.raises(OptionError, match="not empty"):
        CorpusWriter(tmp_path, {})
