from dataclasses import fields
from pathlib import Path

import pytest

from quadpatch.compression.content import COSINE, MODEL, DictionaryReference, Lengths
from quadpatch.compression.header import MAGIC, Counts, Header, write_header
from quadpatch.errors import EncodedMeshError, MeshError, ReadError
from quadpatch.formats.detection import QPZ_MAGIC
from quadpatch.formats.reading import read_scan
from quadpatch.repair import inspect_file
from quadpatch.tasks.inspect import inspect_any
from tests.quadpatch.shapes import open_grid, write_ply

NO_COUNTS = {entry.name: 0 for entry in fields(Counts)}
BODY = b"seven b"


def encoded_file(path: Path, dictionary: DictionaryReference | None = None, kept: int = 0, unit: str = "") -> Path:
    """A file whose header is whole, and whose numbers are none."""
    counts = Counts(**{**NO_COUNTS, "quads": 6, "kept_vertices": kept, "kept_triangles": 2 * kept})
    lengths = Lengths(0.25, (0.0, 1.0, 2.0), 0.1, 0.1)
    header = Header(lengths, unit, dictionary or DictionaryReference(COSINE), counts, (len(BODY), 0, 0))
    path.write_bytes(write_header(header, BODY))
    return path


def test_a_mesh_has_the_facts_of_its_surface(tmp_path: Path) -> None:
    path = write_ply(tmp_path / "scan.ply", open_grid(4))
    assert inspect_any(path) == inspect_file(path)


def test_an_encoded_file_has_the_facts_of_its_header_whatever_its_name(tmp_path: Path) -> None:
    assert inspect_any(encoded_file(tmp_path / "scan.ply", unit="millimeter")) == {
        "format": "qpz",
        "length_unit": "millimeter",
        "vertices": None,
        "triangles": None,
        "encoded": {"max_error": 0.25, "keeps_connectivity": False, "model": None, "model_sha256": None},
        "holes": [],
        "warnings": [],
        "warning_details": [],
    }


def test_an_encoded_file_names_the_model_that_decodes_it_and_counts_what_it_keeps(tmp_path: Path) -> None:
    reference = DictionaryReference(MODEL, "mine@3", bytes(range(32)))
    facts = inspect_any(encoded_file(tmp_path / "scan.qpz", reference, kept=10))
    assert (facts["vertices"], facts["triangles"]) == (10, 20)
    assert facts["encoded"]["keeps_connectivity"] is True
    assert facts["encoded"]["model"] == "mine@3"
    assert facts["encoded"]["model_sha256"] == bytes(range(32)).hex()


@pytest.mark.parametrize("cut", range(4, 60, 7))
def test_a_damaged_header_is_a_coded_error(tmp_path: Path, cut: int) -> None:
    path = encoded_file(tmp_path / "scan.qpz")
    data = path.read_bytes()
    for damaged in (data[:cut], data[:cut] + bytes([data[cut] ^ 0x55]) + data[cut + 1 :], data + b"more"):
        path.write_bytes(damaged)
        with pytest.raises(MeshError):
            inspect_any(path)


def test_a_file_that_is_not_there_is_a_coded_error(tmp_path: Path) -> None:
    with pytest.raises(ReadError):
        inspect_any(tmp_path / "none.ply")


def test_nothing_but_decoding_reads_an_encoded_file(tmp_path: Path) -> None:
    assert QPZ_MAGIC == MAGIC
    for name in ("scan.qpz", "scan.ply", "scan"):
        with pytest.raises(EncodedMeshError, match="decode it first"):
            read_scan(encoded_file(tmp_path / name))
