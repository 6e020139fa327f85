import hashlib
import json
from pathlib import Path

import pytest

from quadpatch.errors import OptionError, ReadError
from training.sources import corpus_sha256, find_sources, split_holdout


def folder_of_meshes(folder: Path) -> Path:
    for name in ("b.ply", "a.stl", "notes.txt"):
        (folder / name).write_bytes(name.encode())
    entry = {"name": "b", "licence": "CC BY 4.0 (someone)", "source_repo": "some/where", "source_path": "b.obj"}
    (folder / "manifest.json").write_text(json.dumps([entry]))
    return folder


def test_a_folder_stands_for_its_meshes_by_name_with_their_licences(tmp_path: Path) -> None:
    a, b = find_sources([folder_of_meshes(tmp_path)])
    assert (a.name, a.licence, a.origin) == ("a", "", "")
    assert b.facts() == {
        "name": "b",
        "sha256": hashlib.sha256(b"b.ply").hexdigest(),
        "licence": "CC BY 4.0 (someone)",
        "origin": "some/where/b.obj",
    }


def test_a_file_named_twice_counts_once(tmp_path: Path) -> None:
    folder = folder_of_meshes(tmp_path)
    assert [source.name for source in find_sources([folder / "b.ply", folder])] == ["b", "a"]


def test_held_out_meshes_are_not_learned_from(tmp_path: Path) -> None:
    kept, held_out = split_holdout(find_sources([folder_of_meshes(tmp_path)]), ["b"])
    assert ([s.name for s in kept], [s.name for s in held_out]) == (["a"], ["b"])


def test_what_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="nothing"):
        find_sources([tmp_path / "nothing.ply"])
    with pytest.raises(OptionError, match="'c'"):
        split_holdout(find_sources([folder_of_meshes(tmp_path)]), ["c"])


@pytest.mark.parametrize("text", ["{", "[1]", '{"name": "a"}', '[{"licence": "x"}]'])
def test_a_broken_manifest_is_refused(tmp_path: Path, text: str) -> None:
    folder = folder_of_meshes(tmp_path)
    (folder / "manifest.json").write_text(text)
    with pytest.raises(ReadError, match="manifest"):
        find_sources([folder])


def test_the_hash_of_a_corpus_does_not_depend_on_the_order_of_its_parts() -> None:
    assert corpus_sha256(["a", "b"]) == corpus_sha256(["b", "a"]) != corpus_sha256(["a", "c"])
